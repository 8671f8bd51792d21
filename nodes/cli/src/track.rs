use crate::failure::Failure;
use std::path::PathBuf;

/// `track`: the nearest C-face of two convex parts along a motion.
#[derive(clap::Args)]
pub struct Args {
    /// Mesh of the moving part A (OBJ, convex), in its own frame, metres.
    #[arg(long)]
    pub moving: PathBuf,
    /// Mesh of the obstacle B (OBJ, convex), in W, metres.
    #[arg(long)]
    pub fixed: PathBuf,
    /// Poses of A in W: CSV `t,x,y,z,qx,qy,qz,qw`.
    #[arg(long)]
    pub poses: PathBuf,
    /// CSV to write.
    #[arg(long)]
    pub out: PathBuf,
    /// Also print the time of a step.
    #[arg(long)]
    pub time: bool,
}

/// Runs `track`.
pub fn run(args: &Args) -> Result<(), Failure> {
    Err(Failure::file(&args.moving, "not available yet"))
}
