//! ROS 2 node `haptic_servo`: tracks contacts in C-space and renders force on the hand at 1 kHz and more.

use cspace_haptics::servo_node::ServoNode;
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const USAGE: &str = "haptic_servo: tracks contacts in C-space and renders the force of compliant motion on the hand.\n\
    Parameters: scene, device.driver, law, gains, limits, ...: see config/haptic_servo.param.yaml.";

fn main() -> ExitCode {
    failure::run(|| ServoNode::start(Host::start_in_real_time("haptic_servo", USAGE)?)?.run())
}
