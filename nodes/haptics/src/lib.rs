//! Contact region, force laws, virtual coupling, passivity, limits.
//!
//! Source: paper section IV for the contact rules; literature is cited where the code goes beyond it.
//! [`Renderer`] is the entry: it follows the hand's pose and gives wrench, surface contact pose and contacts.

mod coupling;
mod depth;
mod formation;
mod gains;
mod law;
mod projection;
mod proxy;
mod region;
mod renderer;
mod solid;
#[cfg(test)]
mod testing;

pub use coupling::{
    Coupling, Displacement, Held, HoldDamping, Limited, Limiter, Passivity, PassivityLimits, SampledLoop, clamped,
    low_pass_share, returnable_energy,
};
pub use formation::{ContactFormation, ContactPoint, FormationKind, MAX_CONTACTS};
pub use gains::{Gains, LawKind};
pub use law::{LawOutput, RenderLaw};
pub use proxy::Coefficients;
pub use renderer::Renderer;
