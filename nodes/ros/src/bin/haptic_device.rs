//! ROS 2 node `haptic_device`: a haptic device alone: pose, twist and buttons out, a commanded wrench in.

use cspace_haptics::device_node::DeviceNode;
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const USAGE: &str = "haptic_device: publishes a haptic device's pose, twist and buttons and shows the wrench of ~/command/wrench.\n\
    Parameters: device.driver (simulated, replay, spacemouse), device.*, frame_id, publish_rate, command_timeout, enabled.";

fn main() -> ExitCode {
    failure::run(|| DeviceNode::start(Host::start_in_real_time("haptic_device", USAGE)?)?.run())
}
