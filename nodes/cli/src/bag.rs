use crate::bag_segment::{self, Cut};
use crate::failure::Failure;
use crate::stdout::say;
use bag::BagInfo;
use std::path::{Path, PathBuf};

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
    /// A recorded run at a glance: ticks, formations over time, depth, force, punctuality.
    Summary {
        /// The bag's directory.
        dir: PathBuf,
        /// The topic of the ticks, if the bag holds those of several servos.
        #[arg(long)]
        topic: Option<String>,
    },
    /// The sequence of contact formations.
    Segment {
        /// The bag's directory.
        dir: PathBuf,
        /// CSV to write.
        #[arg(long)]
        out: PathBuf,
        #[command(flatten)]
        cut: Cut,
    },
    /// The contact states of many runs, and the transitions between them.
    Graph {
        /// The bags' directories.
        #[arg(required = true)]
        dirs: Vec<PathBuf>,
        /// Graph to write: .dot (Graphviz) or .json.
        #[arg(long)]
        out: PathBuf,
        #[command(flatten)]
        cut: Cut,
    },
}

/// Runs `bag`.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::Info { dir } => info(dir),
        Command::Summary { dir, topic } => crate::bag_summary::run(dir, topic.as_deref()),
        Command::Segment { dir, out, cut } => bag_segment::segment(dir, out, cut),
        Command::Graph { dirs, out, cut } => bag_segment::graph(dirs, out, cut),
    }
}

fn info(dir: &Path) -> Result<(), Failure> {
    let info = BagInfo::read(dir).map_err(Failure::plain)?;
    let size: u64 = info.files.iter().map(|(_, bytes)| bytes).sum();
    if size > 0 && info.topics.is_empty() && info.damage.iter().map(|d| d.length).sum::<u64>() == size {
        return Err(Failure::file(dir, "nothing in it is MCAP: name a bag's folder or its .mcap file"));
    }
    say(&format!("bag       {}", dir.display()))?;
    for (name, bytes) in &info.files {
        say(&format!("file      {name}, {:.3} MB", *bytes as f64 * 1e-6))?;
    }
    for name in &info.missing_files {
        say(&format!(
            "missing   {name}: metadata.yaml names it, but it is not in the folder; put it back beside the others"
        ))?;
    }
    let messages = info.messages();
    if let Some((first, last)) = info.times {
        let seconds = (last.0 - first.0) as f64 * 1e-9;
        say(&format!("duration  {seconds:.3} s, from {:.3} to {:.3}", first.as_secs_f64(), last.as_secs_f64()))?;
    }
    if !info.ros_distro.is_empty() {
        say(&format!("recorded  on ROS 2 {}", info.ros_distro))?;
    }
    say(&format!("messages  {messages}"))?;
    for (topic, count) in &info.topics {
        let kind = if topic.type_name.is_empty() { "type lost" } else { &topic.type_name };
        say(&format!("topic     {}, {kind}, {count}", topic.name))?;
    }
    for (topic, ticks) in &info.ticks {
        say(&format!("ticks     {topic}, {} found, {} missing, {} lost", ticks.found, ticks.missing, ticks.lost))?;
    }
    for (name, hash, fits) in &info.scenes {
        say(&format!("scene     {name}, sha256 {hash}{}", if *fits { "" } else { ", DOES NOT FIT" }))?;
    }
    for (version, hash) in &info.configurations {
        say(&format!("config    of cspace_haptics {version}, sha256 {hash}"))?;
    }
    for damage in &info.damage {
        say(&format!("damage    {} at byte {}, {} bytes: {}", damage.file, damage.offset, damage.length, damage.what))?;
    }
    if info.undecodable > 0 {
        say(&format!("damage    {} messages could not be decoded", info.undecodable))?;
    }
    match info.promised_messages {
        None if dir.is_dir() => {
            say("note      metadata.yaml is missing or damaged; `ros2 bag reindex` makes a new one")?
        }
        Some(promised) if promised != messages => {
            say(&format!("note      metadata.yaml promises {promised} messages, {messages} are there"))?;
        }
        _ => {}
    }
    say(match (info.complete, info.missing_files.is_empty()) {
        (true, _) => "complete  yes",
        (false, true) => "complete  no: its writer was stopped, or it is damaged",
        (false, false) => "complete  no: a file is missing",
    })
}
