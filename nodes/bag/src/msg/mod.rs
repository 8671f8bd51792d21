//! Messages as they stand in bags: field for field the .msg files, see there for units, frames and signs.

mod contact;
mod cspace;
mod geometry;
mod health;
mod scene;
mod standard;
mod state;
mod tick;

pub use contact::{BasicContact, CFace, ContactPoint, PrincipalContact};
pub use cspace::LocalCSpace;
pub use geometry::{Point, Pose, PoseStamped, Quaternion, Twist, TwistStamped, Vector3, Wrench, WrenchStamped};
pub use health::ServoHealth;
pub use scene::{SceneDescription, SceneFile, ServoConfiguration};
pub use standard::{Header, Joy, Text, Time};
pub use state::ContactState;
pub use tick::{DeviceSample, Gains, TickBatch, TickRecord};

use serde::{Serialize, de::DeserializeOwned};

/// A ROS message.
pub trait Message: Serialize + DeserializeOwned {
    /// The ROS type, `package/msg/Type`.
    const NAME: &'static str;
}

macro_rules! messages {
    ($($type:ident = $name:literal),* $(,)?) => {
        $(impl Message for $type { const NAME: &'static str = $name; })*
    };
}

messages! {
    Time = "builtin_interfaces/msg/Time",
    Header = "std_msgs/msg/Header",
    Text = "std_msgs/msg/String",
    Joy = "sensor_msgs/msg/Joy",
    PoseStamped = "geometry_msgs/msg/PoseStamped",
    TwistStamped = "geometry_msgs/msg/TwistStamped",
    WrenchStamped = "geometry_msgs/msg/WrenchStamped",
    BasicContact = "cspace_haptics_msgs/msg/BasicContact",
    CFace = "cspace_haptics_msgs/msg/CFace",
    ContactPoint = "cspace_haptics_msgs/msg/ContactPoint",
    ContactState = "cspace_haptics_msgs/msg/ContactState",
    DeviceSample = "cspace_haptics_msgs/msg/DeviceSample",
    Gains = "cspace_haptics_msgs/msg/Gains",
    LocalCSpace = "cspace_haptics_msgs/msg/LocalCSpace",
    PrincipalContact = "cspace_haptics_msgs/msg/PrincipalContact",
    SceneDescription = "cspace_haptics_msgs/msg/SceneDescription",
    SceneFile = "cspace_haptics_msgs/msg/SceneFile",
    ServoConfiguration = "cspace_haptics_msgs/msg/ServoConfiguration",
    ServoHealth = "cspace_haptics_msgs/msg/ServoHealth",
    TickBatch = "cspace_haptics_msgs/msg/TickBatch",
    TickRecord = "cspace_haptics_msgs/msg/TickRecord",
}
