//! The two bodies in contact, uncut: which contacts of their convex pieces are the bodies' own, and which lie nearest.

mod cover;
mod facing;
mod features;
mod gaps;
mod hollow;
mod one_plane;
mod pair;
mod placed;
mod seams;
mod sense;
mod sharpness;
mod solids;

pub(crate) use cover::Cover;
pub(crate) use facing::{closest_places, facing_point};
pub(crate) use hollow::each_hollow_end;
pub(crate) use one_plane::OnePlane;
pub(crate) use pair::{Covered, Pair, SAME, TURN, nearest_in_face};
pub(crate) use placed::Placed;
pub(crate) use seams::{Margin, Seams, is_same_face};
pub(crate) use sense::{Sense, Sensed};
pub(crate) use solids::Solids;
