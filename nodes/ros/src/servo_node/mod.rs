//! The servo as a node: its topics, services and parameters around the loop that runs on a thread of its own.

mod batch;
mod contact_events;
mod cspace_view;
mod device_limits;
mod device_watch;
mod drivers;
mod due;
mod node;
mod pose_file;
mod setup;
mod stamp_watch;
mod topic_link;
mod topics;
mod transforms;

pub use batch::Batcher;
pub use contact_events::ContactEvents;
pub use cspace_view::CSpaceView;
pub use device_limits::DeviceLimits;
pub use device_watch::DeviceWatch;
pub use drivers::open_local;
pub use due::Due;
pub use node::ServoNode;
pub use setup::{apply, declared, scene_file};
pub use stamp_watch::StampWatch;
pub use topic_link::TopicLink;
pub use topics::{Frames, ServoTopics};
pub use transforms::Transforms;
