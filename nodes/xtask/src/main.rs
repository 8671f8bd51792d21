//! Everyday commands of the workspace: `cargo xtask env | demo | test | bench | pictures`.

use clap::{Parser, Subcommand};
use std::process::ExitCode;

mod bench;
mod cargo_build;
mod ci;
mod demo;
mod env;
mod pictures;
mod progress;
mod virtual_machine;
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
    /// Run servo, recorder and inspect on a scene; leaves a bag, a recording for rerun and a summary in out/
    Demo(demo::Arguments),
    /// Run everything that CI runs
    Test(ci::Arguments),
    /// Run the benchmarks
    Bench(bench::Arguments),
    /// Draw the README's pictures anew, without a screen
    Pictures(pictures::Arguments),
    /// Become another program that ends when this process's parent does
    #[command(hide = true)]
    AsChild {
        parent: u32,
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        program: Vec<std::ffi::OsString>,
    },
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Env => env::print(),
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Test(arguments) => ci::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Pictures(arguments) => pictures::run(&arguments),
        Command::AsChild { parent, program } => demo::child::become_child(parent, &program).map(|()| ExitCode::SUCCESS),
    };
    match outcome {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
