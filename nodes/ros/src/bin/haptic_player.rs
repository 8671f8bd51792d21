//! ROS 2 node `haptic_player`: plays a bag at its times.

use cspace_haptics::player::Player;
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const USAGE: &str = "haptic_player: plays what a bag holds, at its times.\n\
    Parameters: bag, topics, rate, loop, paused, start, clock, wait_for_listeners. Service: ~/pause.";

fn main() -> ExitCode {
    failure::run(|| Player::start(Host::start("haptic_player", USAGE)?)?.run())
}
