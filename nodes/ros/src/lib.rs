//! r2r adapters and the ROS 2 executables.
//!
//! A node is made of a [`Host`] (name, clock, signals), a [`parameters::ParameterServer`] and what it does; the
//! executables in `src/bin` put them together.

mod aftermath;
pub mod convert;
pub mod device_node;
pub mod failure;
pub mod follower;
pub mod follower_node;
mod host;
mod inbox;
pub mod parameters;
pub mod pictures;
pub mod player;
pub mod qos;
pub mod recorder;
pub mod servo_node;
mod talker;

pub use aftermath::take_what_is_left;
pub use failure::{Failure, Outcome};
pub use host::Host;
pub use inbox::Inbox;
pub use talker::{Listener, Talker};
