use crate::atomic_file::AtomicFile;
use crate::failure::Failure;
use ::inspect::{Options, Recorder, Sink, Subject};
use scene::Scene;
use servo::TickRecord;
use std::path::Path;
use std::time::Duration;

/// A disk may be slow, but not this slow.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A rerun recording, filled by `fill`; it appears when it is finished. None of `inputs` is overwritten.
pub fn fill(
    rrd: &Path,
    inputs: &[&Path],
    fill: impl FnOnce(&Sink) -> Result<(), Failure>,
) -> Result<AtomicFile, Failure> {
    let file = AtomicFile::create(rrd, inputs)?;
    fill(&Sink::File(file.temporary().to_owned())).map_err(|e| e.known_as(file.temporary(), rrd))?;
    Ok(file)
}

/// Fills a recording with ticks in a scene.
pub fn record(sink: &Sink, scene: &Scene, records: &[TickRecord]) -> Result<(), Failure> {
    let mut recorder = Recorder::new(Subject::of(scene), sink, &Options::default()).map_err(Failure::plain)?;
    records.iter().try_for_each(|r| recorder.tick(r)).map_err(Failure::plain)?;
    recorder.finish(PATIENCE).map_err(Failure::plain)
}
