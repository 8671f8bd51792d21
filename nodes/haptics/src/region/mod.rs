//! The contact region H of a pair (paper section IV.B): which contacts take place together, and where.

mod along_edge;
mod clipper;
mod face_pair;
mod facing_faces;
mod point;
mod span;
mod tied;
mod way;

pub(crate) use clipper::Clipper;
pub(crate) use facing_faces::most_parallel;
pub(crate) use point::{RegionPoint, Scope, push_within};
pub(crate) use tied::{Known, TIED, tied_contacts};
pub(crate) use way::{Gone, Way};
