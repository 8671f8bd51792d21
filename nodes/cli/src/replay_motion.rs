use crate::bag_scene::scene_of;
use crate::csv_io::read_poses;
use crate::failure::Failure;
use bag::msg::{SceneDescription, ServoConfiguration};
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
}

impl Motion {
    /// The hand's poses of a CSV file: every row is a tick, force is wanted from the first on.
    pub fn from_csv(path: &Path, config: &Config) -> Result<Self, Failure> {
        let rows = read_poses(path)?;
        let poses: Vec<(f64, Stamp, Pose)> = rows.iter().map(|r| (r.t, Stamp::from_secs_f64(r.t), r.pose)).collect();
        Ok(Self::from_poses(&poses, config))
    }

    /// A bag of ticks, or else of anyone's poses.
    pub fn from_bag(dir: &Path, config: &Config) -> Result<Self, Failure> {
        match bag::read_ticks(dir, None) {
            Ok(log) if !log.ticks.is_empty() => Ok(Self {
                inputs: log.ticks.iter().map(|t| t.input).collect(),
                times: log.ticks.iter().map(|t| seconds(t.input.stamp)).collect(),
                recorded: log.ticks,
                scene: log.scene,
                configuration: log.configuration,
            }),
            ticks => {
                let log = match (bag::read_poses(dir, None), ticks) {
                    (Ok(log), _) => log,
                    // What is wrong with the ticks says more, where there are any.
                    (Err(e), Ok(_)) | (Err(_), Err(e)) => return Err(Failure::plain(e)),
                };
                if let Some((_, pose)) = log.poses.iter().find(|(_, p)| !p.is_valid()) {
                    return Err(Failure::file(dir, format!("{}: {pose:?} is no pose", log.topic)));
                }
                if log.poses.is_empty() {
                    return Err(Failure::file(dir, "holds neither ticks nor poses"));
                }
                let poses: Vec<_> = log.poses.iter().map(|(s, p)| (seconds(*s), *s, *p)).collect();
                Ok(Self::from_poses(&poses, config))
            }
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
        }
    }

    /// The scene of the bag, built as if from its files.
    pub fn own_scene(&self, bag: &Path) -> Result<Option<Scene>, Failure> {
        let Some(s) = &self.scene else { return Ok(None) };
        scene_of(bag, s).map(Some)
    }
}

/// Divided, not multiplied: the nearest number to the decimal one, which reads back from a CSV of poses.
fn seconds(stamp: Stamp) -> f64 {
    stamp.0 as f64 / 1e9
}
