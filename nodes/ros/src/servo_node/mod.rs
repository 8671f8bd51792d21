//! The servo as a node: its topics, services and parameters around the loop that runs on a thread of its own.

mod batch;
mod topics;

pub use batch::Batcher;
pub use topics::{Frames, ServoTopics};
