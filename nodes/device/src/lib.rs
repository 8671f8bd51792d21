//! `HapticDevice` and its drivers: simulated operator, pose replay, SpaceMouse.

mod haptic_device;

pub use haptic_device::{DeviceSpec, HapticDevice, Sample};
