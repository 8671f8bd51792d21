//! Everyday commands of the workspace: `cargo xtask env | demo | test | bench | pictures`.

use clap::{Parser, Subcommand};
use std::process::ExitCode;

mod env;
mod progress;
mod workspace;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Set-up and everyday commands of cspace_haptics")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Bring ROS 2 and the messages, and print the environment to source: eval "$(cargo xtask env)"
    Env,
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Env => env::print(),
    };
    match outcome {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
