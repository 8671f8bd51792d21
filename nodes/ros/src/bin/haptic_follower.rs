//! ROS 2 node `haptic_follower`: a small example of a teleoperated robot behind a network with delay and loss.

use cspace_haptics::{failure, follower_node};
use std::process::ExitCode;

fn main() -> ExitCode {
    failure::run(follower_node::run)
}
