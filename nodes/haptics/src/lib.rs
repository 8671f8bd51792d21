//! Contact region, force laws, virtual coupling, passivity, limits.
//!
//! Source: paper section IV; MATH sections are cited where the code goes beyond it.

mod coupling;
mod formation;
mod gains;
mod law;
mod limiter;
mod passivity;

pub use coupling::{Coupling, low_pass_share};
pub use formation::{ContactFormation, ContactPoint, FormationKind, MAX_CONTACTS};
pub use gains::{Gains, LawKind};
pub use law::{LawOutput, RenderLaw};
pub use limiter::{Limited, Limiter};
pub use passivity::{Displacement, Passivity, PassivityLimits, returnable_energy};
