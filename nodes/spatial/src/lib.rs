//! Pose, twist, wrench and time: units and frames said once.
//!
//! SI units, `f64`, right-handed frames. `W` is the world, `A` the manipulated body, `B` an obstacle.
//! A pose is named after what it maps: `world_from_a` takes a point of A to the world.

mod pose;
mod stamp;
mod twist;
mod wrench;

pub use glam::{DMat3, DQuat, DVec3};
pub use pose::Pose;
pub use stamp::Stamp;
pub use twist::Twist;
pub use wrench::Wrench;
