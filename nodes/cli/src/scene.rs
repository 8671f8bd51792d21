use crate::failure::Failure;
use std::path::PathBuf;

/// `scene`: look at scenes.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Load a scene with all its meshes and say what it is made of.
    Check {
        /// The scene file.
        scene: PathBuf,
    },
}

/// Runs `scene`.
pub fn run(args: &Args) -> Result<(), Failure> {
    let Command::Check { scene } = &args.command;
    Err(Failure::file(scene, "not available yet"))
}
