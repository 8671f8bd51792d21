use crate::failure::Failure;
use std::path::PathBuf;

/// `inspect`: a rerun recording of a bag or a scene.
#[derive(clap::Args)]
pub struct Args {
    /// A bag's directory or a scene.yaml.
    source: PathBuf,
    /// The recording to write.
    #[arg(long)]
    rrd: PathBuf,
}

/// Runs `inspect`.
pub fn run(args: &Args) -> Result<(), Failure> {
    Err(Failure::file(&args.source, format!("cannot write {}: not available yet", args.rrd.display())))
}
