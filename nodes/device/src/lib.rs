//! `HapticDevice` and its drivers: simulated operator, pose replay, SpaceMouse.

mod arm;
mod haptic_device;
mod operator_config;
mod operator_plan;
mod simulated_operator;
mod stroke;
mod tremor;

pub use haptic_device::{DeviceSpec, HapticDevice, Sample};
pub use operator_config::{OperatorConfig, OperatorError};
pub use operator_plan::{Bounds, OperatorPlan, Waypoint};
pub use simulated_operator::SimulatedOperator;
