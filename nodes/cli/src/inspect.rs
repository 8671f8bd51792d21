use crate::failure::Failure;
use crate::outputs::spare;
use ::inspect::{Options, Recorder, Sink, Subject, record_overview};
use bag::{BagReader, Ticks};
use scene::{Bundle, Scene};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// `inspect`: a rerun recording of a bag or a scene.
#[derive(clap::Args)]
pub struct Args {
    /// A bag's directory or a scene.yaml.
    source: PathBuf,
    /// The recording to write.
    #[arg(long)]
    rrd: PathBuf,
}

/// A disk may be slow, but not this slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// Runs `inspect`.
pub fn run(args: &Args) -> Result<(), Failure> {
    spare(&args.rrd, &[&args.source])?;
    let sink = Sink::File(args.rrd.clone());
    if args.source.is_dir() { bag(&args.source, &sink) } else { scene(&args.source, &args.rrd, &sink) }
}

fn scene(path: &Path, rrd: &Path, sink: &Sink) -> Result<(), Failure> {
    let scene = Scene::load(path).map_err(Failure::plain)?;
    let files = scene.bundle.paths();
    spare(rrd, &files.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    record_overview(&Subject::of(&scene), sink, PATIENCE).map_err(Failure::plain)
}

/// The recorder is opened at the first tick: a bag carries its scene before its ticks, and a bag without either leaves
/// no file behind.
fn bag(dir: &Path, sink: &Sink) -> Result<(), Failure> {
    let reader = BagReader::open(dir).map_err(Failure::plain)?;
    let mut ticks = Ticks::new(&reader, None).map_err(Failure::plain)?;
    let mut recorder = None;
    while let Some(tick) = ticks.next() {
        let tick = tick.map_err(Failure::plain)?;
        let recorder = match &mut recorder {
            Some(recorder) => recorder,
            None => {
                let description = ticks.scene.as_ref();
                let description =
                    description.ok_or_else(|| Failure::file(dir, "the bag holds no scene before its ticks"))?;
                let files = description.files.iter().map(|f| (f.path.clone(), f.data.clone())).collect();
                let path = dir.join(format!("{}.yaml", description.name));
                let scene =
                    Scene::build(Bundle { path, yaml: description.yaml.clone(), files }).map_err(Failure::plain)?;
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
