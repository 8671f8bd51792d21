use crate::failure::Failure;
use std::path::PathBuf;

/// `bag`: what a bag holds, and its contact states.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Topics, counts, times, scene and gaps of a bag.
    Info {
        /// The bag's directory.
        dir: PathBuf,
    },
    /// The sequence of contact formations.
    Segment {
        /// The bag's directory.
        dir: PathBuf,
        /// CSV to write.
        #[arg(long)]
        out: PathBuf,
    },
}

/// Runs `bag`.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::Info { dir } => Err(Failure::file(dir, "not available yet")),
        Command::Segment { out, .. } => Err(Failure::file(out, "not available yet")),
    }
}
