use crate::bag_scene::scene_of;
use crate::csv_io::{read_poses, with_unit_rotation};
use crate::failure::Failure;
use bag::msg::{Message, PoseStamped, SceneDescription, ServoConfiguration, TickBatch};
use bag::{BagError, BagReader, Damage, TickLog};
use scene::Scene;
use servo::{Config, TickInput, TickRecord};
use spatial::{Pose, Stamp};
use std::path::Path;

/// What is to be rendered: the ticks' inputs, and what was recorded of them, if they come from a bag of ticks.
pub struct Motion {
    /// One for each tick.
    pub inputs: Vec<TickInput>,
    /// Time of each tick as the output shows it, s.
    pub times: Vec<f64>,
    /// The recorded ticks; empty for mere poses.
    pub recorded: Vec<TickRecord>,
    /// The scene of the bag, if it holds one.
    pub scene: Option<SceneDescription>,
    /// The configuration of the bag, if it holds one.
    pub configuration: Option<ServoConfiguration>,
    /// What is wrong with the bag, in words.
    pub notes: Vec<String>,
}

impl Motion {
    /// The hand's poses of a CSV file: every row is a tick, force is wanted from the first on.
    pub fn from_csv(path: &Path, config: &Config) -> Result<Self, Failure> {
        let rows = read_poses(path)?;
        let poses: Vec<(f64, Stamp, Pose)> = rows.iter().map(|r| (r.t, Stamp::from_secs_f64(r.t), r.pose)).collect();
        Ok(Self::from_poses(&poses, config))
    }

    /// A bag of ticks, or else of anyone's poses; `topic` chooses between several.
    pub fn from_bag(dir: &Path, topic: Option<&str>, config: &Config) -> Result<Self, Failure> {
        let ticks = match bag::read_ticks(dir, topic) {
            Ok(log) if !log.ticks.is_empty() => return Ok(Self::from_ticks(log)),
            other => other,
        };
        let log = match (bag::read_poses(dir, topic), ticks) {
            (Ok(log), _) => log,
            // Of a bag without ticks one wants to know what is wrong with its poses.
            (Err(poses), Err(ticks)) => return Err(no_motion(dir, topic, &ticks, &poses)),
            (Err(poses), Ok(_)) => return Err(Failure::plain(poses)),
        };
        if let Some((_, pose)) = log.poses.iter().find(|(_, p)| !p.is_valid()) {
            return Err(Failure::file(dir, format!("{}: {pose:?} is no pose", log.topic)));
        }
        if log.poses.is_empty() {
            return Err(Failure::file(dir, "holds neither ticks nor poses"));
        }
        let poses: Vec<_> = log.poses.iter().map(|(s, p)| (seconds(*s), *s, with_unit_rotation(*p))).collect();
        Ok(Self { notes: damage_notes(&log.damage), ..Self::from_poses(&poses, config) })
    }

    fn from_ticks(log: TickLog) -> Self {
        let mut notes = damage_notes(&log.damage);
        if log.missing > 0 {
            notes.push(format!("gap     {} ticks are missing: what follows them cannot be identical", log.missing));
        }
        Self {
            inputs: log.ticks.iter().map(|t| t.input).collect(),
            times: times_of(&log.ticks),
            recorded: log.ticks,
            scene: log.scene,
            configuration: log.configuration,
            notes,
        }
    }

    fn from_poses(poses: &[(f64, Stamp, Pose)], config: &Config) -> Self {
        let mut last_t = None;
        let mut inputs = Vec::with_capacity(poses.len());
        for (i, &(t, stamp, pose)) in poses.iter().enumerate() {
            let dt = last_t.map_or(config.realtime.period(), |last| t - last);
            last_t = Some(t);
            let mut input =
                TickInput { sequence: i as u64, stamp, dt, gains: config.gains, enabled: true, ..TickInput::default() };
            input.sample.sequence = i as u64 + 1;
            input.sample.stamp = stamp;
            input.sample.pose = pose;
            input.sample.connected = true;
            inputs.push(input);
        }
        Self {
            inputs,
            times: poses.iter().map(|p| p.0).collect(),
            recorded: Vec::new(),
            scene: None,
            configuration: None,
            notes: Vec::new(),
        }
    }

    /// The scene of the bag, built as if from its files.
    pub fn own_scene(&self, bag: &Path) -> Result<Option<Scene>, Failure> {
        let Some(s) = &self.scene else { return Ok(None) };
        scene_of(bag, s).map(Some)
    }
}

/// The time of each tick, s. A stamp counts whole nanoseconds, but `dt` is the difference of two numbers as they stood in a
/// CSV: where the sum rounds to the stamp, it is the number that stood there.
fn times_of(ticks: &[TickRecord]) -> Vec<f64> {
    let mut last = None;
    let time = |tick: &TickRecord| {
        let sum = last.map(|last: f64| last + tick.input.dt).filter(|t| Stamp::from_secs_f64(*t) == tick.input.stamp);
        *last.insert(sum.unwrap_or_else(|| seconds(tick.input.stamp)))
    };
    ticks.iter().map(time).collect()
}

/// Divided, not multiplied: the nearest number to the decimal one, which reads back from a CSV of poses.
fn seconds(stamp: Stamp) -> f64 {
    stamp.0 as f64 / 1e9
}

/// Why neither ticks nor poses were found.
fn no_motion(dir: &Path, topic: Option<&str>, ticks: &BagError, poses: &BagError) -> Failure {
    let Ok(reader) = BagReader::open(dir) else { return Failure::plain(poses) };
    let names = |type_name: &str| -> Vec<String> {
        reader.topics_of(type_name).iter().map(|&i| reader.topics()[i].name.clone()).collect()
    };
    let (of_ticks, of_poses) = (names(TickBatch::NAME), names(PoseStamped::NAME));
    match topic {
        _ if of_ticks.is_empty() && of_poses.is_empty() => {
            Failure::file(dir, reader.absent(&[TickBatch::NAME, PoseStamped::NAME]))
        }
        Some(t) if !of_ticks.is_empty() && !of_ticks.iter().chain(&of_poses).any(|n| n == t) => {
            let all = [of_ticks, of_poses].concat().join(", ");
            Failure::file(dir, format!("no ticks or poses on {t}; choose one of {all} (--topic)"))
        }
        _ if of_ticks.is_empty() => Failure::plain(poses),
        _ => Failure::plain(ticks),
    }
}

/// What could not be read of a bag, a line each.
pub fn damage_notes(damage: &[Damage]) -> Vec<String> {
    damage.iter().map(|d| format!("damage  {} at byte {}: {}", d.file, d.offset, d.what)).collect()
}
