use crate::failure::Failure;
use ::inspect::{Options, Recorder, Sink, Subject};
use scene::Scene;
use servo::TickRecord;
use std::path::Path;
use std::time::Duration;

/// A disk may be slow, but not this slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// Writes a rerun recording of ticks in a scene.
pub fn record(rrd: &Path, scene: &Scene, records: &[TickRecord]) -> Result<(), Failure> {
    let sink = Sink::File(rrd.to_owned());
    let mut recorder = Recorder::new(Subject::of(scene), &sink, &Options::default()).map_err(Failure::plain)?;
    records.iter().try_for_each(|r| recorder.tick(r)).map_err(Failure::plain)?;
    recorder.finish(PATIENCE).map_err(Failure::plain)
}
