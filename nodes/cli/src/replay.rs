use crate::failure::Failure;
use std::path::PathBuf;

/// `replay`: render a motion in a scene.
#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("motion").required(true).args(["poses", "bag"])))]
pub struct Args {
    /// The scene file.
    #[arg(long, required_unless_present = "bag")]
    pub scene: Option<PathBuf>,
    /// Poses of A in W, the hand's: CSV `t,x,y,z,qx,qy,qz,qw`.
    #[arg(long)]
    pub poses: Option<PathBuf>,
    /// A bag with ticks or poses.
    #[arg(long)]
    pub bag: Option<PathBuf>,
    /// CSV to write.
    #[arg(long)]
    pub out: PathBuf,
    /// The force law: paper, pstar, blended or proxy.
    #[arg(long)]
    pub law: Option<String>,
    /// Also write the ticks as a bag.
    #[arg(long)]
    pub bag_out: Option<PathBuf>,
    /// Also write a rerun recording.
    #[arg(long)]
    pub rrd: Option<PathBuf>,
    /// Also print the time of a step.
    #[arg(long)]
    pub time: bool,
}

/// Runs `replay`.
pub fn run(args: &Args) -> Result<(), Failure> {
    Err(Failure::file(&args.out, "not available yet"))
}
