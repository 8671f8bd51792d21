//! ROS 2 node `haptic_follower`: a small example of a teleoperated robot behind a network with delay and loss.

use cspace_haptics::{failure, follower_node};
use std::process::ExitCode;

const USAGE: &str = "haptic_follower: follows haptic_servo/proxy_pose with limited speed and acceleration and sends the measured\n\
    wrench back on ~/wrench (remap it to haptic_servo/remote_wrench).";

fn main() -> ExitCode {
    failure::run(|| follower_node::run(USAGE))
}
