//! Contact region, force laws, virtual coupling, passivity, limits.
//!
//! Source: paper section IV; MATH sections are cited where the code goes beyond it.

mod formation;
mod gains;
mod law;

pub use formation::{ContactFormation, ContactPoint, FormationKind, MAX_CONTACTS};
pub use gains::{Gains, LawKind};
pub use law::{LawOutput, RenderLaw};
