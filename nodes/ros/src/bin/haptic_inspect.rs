//! ROS 2 node `haptic_inspect`: draws a servo's physical space and C-space with rerun, to a file or a running viewer.

use cspace_haptics::parameters::{ParameterServer, yaml_template};
use cspace_haptics::pictures::{PictureOptions, Pictures};
use cspace_haptics::{Host, Outcome, failure, take_what_is_left};
use std::process::ExitCode;
use std::time::Duration;

const WHAT: &str = "draws a haptic servo's physical space and C-space with rerun.";

fn main() -> ExitCode {
    failure::run(
        || Host::start("haptic_inspect", WHAT, || yaml_template("haptic_inspect", &PictureOptions::declared())),
        body,
    )
}

fn body(host: &mut Host) -> Outcome<()> {
    let mut parameters = ParameterServer::new(&mut host.node, PictureOptions::declared())?;
    let namespace = host.node.namespace()?;
    let options = PictureOptions::from_parameters(&parameters, &namespace)?;
    let mut pictures = Pictures::new(host, options)?;
    host.say_ready();
    while !host.stopped() {
        pictures.turn(host, Duration::from_millis(20))?;
        parameters.serve(host.now(), &mut |_| Ok(()))?;
    }
    take_what_is_left(|| pictures.turn(host, Duration::from_millis(10)))?;
    let said = pictures.finish()?;
    host.say(&said);
    Ok(())
}
