use crate::atomic_file::AtomicFile;
use crate::bag_scene::scene_of;
use crate::failure::Failure;
use crate::replay_motion::damage_notes;
use crate::stdout::say;
use bag::msg::ServoConfiguration;
use bag::{BagReader, FeatureBook, Segment, SegmentOptions, Segmenter, StateGraph, Ticks};
use servo::Config;
use std::path::{Path, PathBuf};

/// How runs are cut into contact states.
#[derive(clap::Args)]
pub struct Cut {
    /// A contact state that lasts less is none, s; otherwise `contacts.debounce` of the bag's configuration (0.02).
    #[arg(long, value_parser = not_negative, allow_negative_numbers = true)]
    debounce: Option<f64>,
    /// A contact begins once the hand is this deep, metres; otherwise `contacts.min_depth` of the bag (1e-7).
    #[arg(long, value_parser = not_negative, allow_negative_numbers = true)]
    min_depth: Option<f64>,
    /// The topic of the ticks, if the bag holds those of several servos.
    #[arg(long)]
    topic: Option<String>,
    /// The scene file, if the bag does not carry its scene.
    #[arg(long)]
    scene: Option<PathBuf>,
}

impl Cut {
    /// What was asked for, else what the servo itself went by, so that live and afterwards the same states are seen.
    fn options(&self, recorded: Option<&ServoConfiguration>) -> SegmentOptions {
        let own = recorded.and_then(|c| Config::from_yaml(&c.yaml).ok()).unwrap_or_default();
        let own = SegmentOptions::from(&own.contacts);
        SegmentOptions {
            debounce: self.debounce.unwrap_or(own.debounce),
            min_depth: self.min_depth.unwrap_or(own.min_depth),
        }
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("not a number from 0 on".to_owned()),
    }
}

/// `bag segment`: the contact states of a run as CSV.
pub fn segment(dir: &Path, out: &Path, cut: &Cut) -> Result<(), Failure> {
    let run = Run::read(dir, cut)?;
    let mut csv = AtomicFile::create(out, &[dir])?;
    csv.write("t_begin,t_end,formation,principal_contacts,mean_force_n,max_force_n,work_j,mean_torque_nm,max_torque_nm,max_depth_m,ticks\n")?;
    for segment in &run.segments {
        let s = &segment.statistics;
        csv.write(&format!(
            "{},{},{},{},{},{},{},{},{},{},{}\n",
            seconds(segment.begin),
            seconds(segment.end),
            segment.kind.name(),
            segment.label(),
            s.mean_force(),
            s.max_force,
            s.work,
            s.mean_torque(),
            s.max_torque,
            s.max_depth,
            s.ticks,
        ))?;
    }
    csv.finish()?;
    run.damage.iter().try_for_each(|d| say(d))?;
    say(&format!("{} contact states", run.segments.len()))
}

/// `bag graph`: the contact states of many runs and the transitions between them, as DOT or JSON.
pub fn graph(dirs: &[PathBuf], out: &Path, cut: &Cut) -> Result<(), Failure> {
    let is_json = match out.extension().and_then(|e| e.to_str()) {
        Some("json") => true,
        Some("dot" | "gv") => false,
        _ => return Err(Failure::file(out, "the name must end in .dot or .json")),
    };
    let mut graph = StateGraph::default();
    let mut scene: Option<(String, &Path)> = None;
    for dir in dirs {
        let run = Run::read(dir, cut)?;
        // Features are numbered by scene: states of different scenes have nothing to do with each other.
        if let (Some((known, first)), Some(hash)) = (&scene, &run.scene_hash)
            && known != hash
        {
            return Err(Failure::file(dir, format!("its scene is another than that of {}", first.display())));
        }
        scene = scene.or(run.scene_hash.map(|hash| (hash, dir.as_path())));
        graph.add(&run.segments);
    }
    let mut file = AtomicFile::create(out, &dirs.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    file.write(&if is_json { graph.to_json() } else { graph.to_dot() })?;
    file.finish()?;
    let transitions: u64 = graph.transitions.values().sum();
    say(&format!("{} runs, {} contact states, {transitions} transitions", graph.runs, graph.states.len()))
}

struct Run {
    segments: Vec<Segment>,
    scene_hash: Option<String>,
    damage: Vec<String>,
}

impl Run {
    fn read(dir: &Path, cut: &Cut) -> Result<Self, Failure> {
        let reader = BagReader::open(dir).map_err(Failure::plain)?;
        let mut ticks = Ticks::new(&reader, cut.topic.as_deref()).map_err(Failure::plain)?;
        let description = ticks.find_scene();
        let scene = match (&cut.scene, &description) {
            (Some(path), _) => Some(scene::Scene::load(path).map_err(Failure::plain)?),
            (None, Some(description)) => Some(scene_of(dir, description)?),
            (None, None) => None,
        };
        let options = cut.options(ticks.find_configuration().as_ref());
        let mut segmenter = Segmenter::new(options, scene.map(|s| FeatureBook::new(&s.world)));
        let mut segments = Vec::new();
        for tick in ticks.by_ref() {
            let change = segmenter.push(&tick.map_err(Failure::plain)?);
            segments.extend(change.and_then(|c| c.ended));
        }
        segments.extend(segmenter.finish());
        let damage = damage_notes(ticks.damage());
        Ok(Self { segments, scene_hash: description.map(|d| d.sha256), damage })
    }
}

/// Seconds with all nine digits: a float would lose the last ones of a time since 1970.
fn seconds(stamp: spatial::Stamp) -> String {
    let sign = if stamp.0 < 0 { "-" } else { "" };
    let ns = stamp.0.unsigned_abs();
    format!("{sign}{}.{:09}", ns / 1_000_000_000, ns % 1_000_000_000)
}
