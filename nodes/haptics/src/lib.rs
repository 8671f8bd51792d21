//! Contact region, force laws, virtual coupling, passivity, limits.
//!
//! Source: paper section IV for the contact rules; literature is cited where the code goes beyond it.
//! [`Renderer`] is the entry: it follows the hand's pose and gives wrench, surface contact pose and contacts.

mod compromise;
mod coupling;
mod depth_law;
mod face_pair;
mod facing;
mod formation;
mod friction;
mod gains;
mod hollow;
mod law;
mod limiter;
mod pair;
mod paper_torque;
mod passivity;
mod placed;
mod projection;
mod proxy;
mod proxy_view;
mod reduced_hull;
mod region;
mod renderer;
mod sampled_loop;
mod scp;
mod seams;
mod sense;
mod shares;
mod solid;
mod span;
mod steadying;
#[cfg(test)]
mod testing;
mod tied;

pub use coupling::{Coupling, low_pass_share};
pub use formation::{ContactFormation, ContactPoint, FormationKind, MAX_CONTACTS};
pub use friction::Coefficients;
pub use gains::{Gains, LawKind};
pub use law::{LawOutput, RenderLaw};
pub use limiter::{Limited, Limiter, clamped};
pub use passivity::{Displacement, Held, Passivity, PassivityLimits, returnable_energy};
pub use renderer::Renderer;
pub use sampled_loop::{HoldDamping, SampledLoop};
