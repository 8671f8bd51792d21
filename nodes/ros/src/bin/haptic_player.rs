//! ROS 2 node `haptic_player`: plays a bag at its times.

use cspace_haptics::parameters::yaml_template;
use cspace_haptics::player::{Player, declared};
use cspace_haptics::{Host, failure};
use std::process::ExitCode;

const WHAT: &str = "plays what a bag holds, at its times; service: ~/pause.";

fn main() -> ExitCode {
    failure::run(
        || Host::start("haptic_player", WHAT, || yaml_template("haptic_player", &declared())),
        |host| Player::start(host)?.run(),
    )
}
