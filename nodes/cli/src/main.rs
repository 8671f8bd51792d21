//! The program `cspace-haptics`: contact tracking, rendering, scene checks, bags and pictures without ROS.

mod atomic_file;
mod bag;
mod bag_out;
mod bag_scene;
mod bag_segment;
mod bag_summary;
mod csv_io;
mod failure;
mod half_written;
#[cfg(feature = "inspect")]
mod inspect;
mod outputs;
mod replay;
mod replay_motion;
#[cfg(feature = "inspect")]
mod rrd;
mod scene;
mod stdout;
mod step_time;
mod track;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Contact tracking and force rendering in configuration space, offline.
#[derive(Parser)]
#[command(name = "cspace-haptics", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Track the nearest C-face of two convex parts along a motion.
    Track(track::Args),
    /// Render a motion in a scene: contacts, proxy pose and wrench of every tick.
    Replay(replay::Args),
    /// Look at scenes.
    Scene(scene::Args),
    /// Look at bags.
    Bag(bag::Args),
    /// Write a rerun recording of a bag or a scene.
    #[cfg(feature = "inspect")]
    Inspect(inspect::Args),
}

fn main() -> ExitCode {
    // Usage errors leave here with exit code 2.
    let cli = Cli::parse();
    half_written::remove_when_interrupted();
    let result = match cli.command {
        Command::Track(args) => track::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Scene(args) => scene::run(&args),
        Command::Bag(args) => bag::run(&args),
        #[cfg(feature = "inspect")]
        Command::Inspect(args) => inspect::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            stdout::complain(&failure);
            ExitCode::FAILURE
        }
    }
}
