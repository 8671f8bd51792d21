//! ROS 2 node `haptic_device`: a haptic device alone: pose, twist and buttons out, a commanded wrench in.

use cspace_haptics::device_node::{DeviceNode, declared};
use cspace_haptics::parameters::yaml_template;
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const WHAT: &str = "publishes a haptic device's pose, twist and buttons and shows the wrench of ~/command/wrench.";

fn main() -> ExitCode {
    failure::run(
        || Host::start_in_real_time("haptic_device", WHAT, || yaml_template("haptic_device", &declared())),
        |host| DeviceNode::start(host)?.run(),
    )
}
