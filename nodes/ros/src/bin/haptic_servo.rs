//! ROS 2 node `haptic_servo`: tracks contacts in C-space and renders force on the hand at 1 kHz and more.

use cspace_haptics::servo_node::ServoNode;
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const WHAT: &str = "tracks contacts in C-space and renders the force of compliant motion on the hand.";

fn main() -> ExitCode {
    failure::run(
        || Host::start_in_real_time("haptic_servo", WHAT, servo::config::yaml_template),
        |host| ServoNode::start(host)?.run(),
    )
}
