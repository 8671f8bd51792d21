use crate::bag_scene::scene_of;
use crate::failure::Failure;
use crate::stdout::say;
use bag::{BagReader, RunSummary, Ticks};
use std::path::Path;

/// `bag summary`: what a recorded run came to.
pub fn run(dir: &Path, topic: Option<&str>) -> Result<(), Failure> {
    let reader = BagReader::open(dir).map_err(Failure::plain)?;
    let mut ticks = Ticks::new(&reader, topic).map_err(Failure::plain)?;
    let scene = ticks.find_scene().map(|description| scene_of(dir, &description)).transpose()?;
    let vertices = scene.iter().flat_map(|s| &s.world.moving).flat_map(|part| part.vertices()).copied().collect();
    let mut summary = RunSummary::of_part(vertices);
    for tick in ticks.by_ref() {
        summary.add(&tick.map_err(Failure::plain)?);
    }
    say(&format!("ticks recorded  {}", summary.ticks()))?;
    say(&format!("ticks lost      {}", ticks.missing()))?;
    for damage in ticks.damage() {
        say(&format!("damage          {} at byte {}: {}", damage.file, damage.offset, damage.what))?;
    }
    say(summary.to_string().trim_end())
}
