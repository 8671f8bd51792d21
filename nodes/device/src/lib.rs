//! `HapticDevice` and its drivers: simulated operator, pose replay, SpaceMouse, and whatever speaks through a topic.

mod arm;
mod haptic_device;
mod operator_config;
mod operator_plan;
mod replay;
mod simulated_operator;
pub mod spacemouse;
mod stroke;
mod topic;
mod tremor;

pub use haptic_device::{DeviceSpec, HapticDevice, Sample};
pub use operator_config::{OperatorConfig, OperatorError};
pub use operator_plan::{Bounds, OperatorPlan, Waypoint};
pub use replay::{Replay, ReplayError};
pub use simulated_operator::SimulatedOperator;
pub use spacemouse::{SpaceMouse, SpaceMouseConfig, SpaceMouseMode, SpaceMouseMonitor};
pub use topic::{TopicConfig, TopicDevice, TopicPort, topic_device};
