//! ROS 2 node `haptic_recorder`: records topics into a rosbag2 MCAP folder that survives a kill -9.

use cspace_haptics::parameters::{ParameterServer, yaml_template};
use cspace_haptics::recorder::{Recorder, RecorderOptions};
use cspace_haptics::{Host, Outcome, failure, take_what_is_left};
use std::process::ExitCode;
use std::time::Duration;

const WHAT: &str = "records topics into a rosbag2 MCAP folder.";

fn main() -> ExitCode {
    failure::run(
        || Host::start("haptic_recorder", WHAT, || yaml_template("haptic_recorder", &RecorderOptions::declared())),
        body,
    )
}

fn body(host: &mut Host) -> Outcome<()> {
    let mut parameters = ParameterServer::new(&mut host.node, RecorderOptions::declared())?;
    let namespace = host.node.namespace()?;
    let mut recorder = Recorder::create(RecorderOptions::from_parameters(&parameters, &namespace)?)?;
    host.say_ready();
    while !host.stopped() {
        recorder.turn(host, Duration::from_millis(20))?;
        parameters.serve(host.now(), &mut |_| Ok(()))?;
    }
    take_what_is_left(|| recorder.turn(host, Duration::from_millis(10)))?;
    let summary = recorder.finish()?;
    host.say(&summary.to_string());
    Ok(())
}
