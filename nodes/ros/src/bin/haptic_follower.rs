//! ROS 2 node `haptic_follower`: a small example of a teleoperated robot behind a network with delay and loss.

use cspace_haptics::follower_node::{FollowerNode, declared};
use cspace_haptics::parameters::yaml_template;
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const WHAT: &str = "follows haptic_servo/proxy_pose with limited speed and acceleration, and sends the measured wrench back\n\
    on ~/wrench (remap it to haptic_servo/remote_wrench).";

fn main() -> ExitCode {
    failure::run(
        || Host::start("haptic_follower", WHAT, || yaml_template("haptic_follower", &declared())),
        |host| FollowerNode::start(host)?.run(),
    )
}
