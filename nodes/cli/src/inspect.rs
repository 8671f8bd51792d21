use crate::bag_scene::scene_of;
use crate::failure::Failure;
use crate::outputs::spare;
use crate::rrd::{PATIENCE, fill};
use ::inspect::{Options, Recorder, Sink, Subject, record_overview};
use bag::{BagReader, Ticks};
use scene::Scene;
use std::path::{Path, PathBuf};

/// `inspect`: a rerun recording of a bag or a scene.
#[derive(clap::Args)]
pub struct Args {
    /// A bag's directory or a scene.yaml.
    source: PathBuf,
    /// The recording to write.
    #[arg(long)]
    rrd: PathBuf,
    /// The bag's topic of ticks, if it holds those of several servos.
    #[arg(long)]
    topic: Option<String>,
    /// The scene file, if the bag does not carry its scene.
    #[arg(long)]
    scene: Option<PathBuf>,
}

/// Runs `inspect`.
pub fn run(args: &Args) -> Result<(), Failure> {
    let file = fill(&args.rrd, &[&args.source], |sink| {
        if args.source.is_dir() { bag(&args.source, args, sink) } else { scene(args, sink) }
    })?;
    file.finish()
}

fn scene(args: &Args, sink: &Sink) -> Result<(), Failure> {
    let scene = load(&args.source, &args.rrd)?;
    record_overview(&Subject::of(&scene), sink, PATIENCE).map_err(Failure::plain)
}

/// A scene none of whose files is the one to write.
fn load(path: &Path, rrd: &Path) -> Result<Scene, Failure> {
    let scene = Scene::load(path).map_err(Failure::plain)?;
    let files = scene.bundle.paths();
    spare(rrd, &files.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    Ok(scene)
}

/// The scene may stand anywhere in the bag: a recorder that subscribes to the ticks first gets them first. The picture's
/// scale is that of the first tick's limits.
fn bag(dir: &Path, args: &Args, sink: &Sink) -> Result<(), Failure> {
    let reader = BagReader::open(dir).map_err(Failure::plain)?;
    let ticks = Ticks::new(&reader, args.topic.as_deref()).map_err(Failure::plain)?;
    let scene = match (&args.scene, ticks.find_scene()) {
        (Some(path), _) => load(path, &args.rrd)?,
        (None, Some(description)) => scene_of(dir, &description)?,
        (None, None) => return Err(Failure::file(dir, "the bag holds no scene: name one with --scene")),
    };
    let mut recorder = None;
    for tick in ticks {
        let tick = tick.map_err(Failure::plain)?;
        let recorder = match &mut recorder {
            Some(recorder) => recorder,
            None => {
                let gains = &tick.input.gains;
                let options = Options { full_scale: (gains.max_force, gains.max_torque), ..Options::default() };
                recorder.insert(Recorder::new(Subject::of(&scene), sink, &options).map_err(Failure::plain)?)
            }
        };
        recorder.tick(&tick).map_err(Failure::plain)?;
    }
    let recorder = recorder.ok_or_else(|| Failure::file(dir, "the bag holds no ticks"))?;
    recorder.finish(PATIENCE).map_err(Failure::plain)
}
