use crate::msg::{Message, SceneDescription, ServoConfiguration, TickBatch};
use crate::{BagError, BagReader, Damage, Topic, cdr};
use spatial::Stamp;
use std::collections::BTreeMap;
use std::path::Path;

/// What a bag holds, found by reading all of it.
#[derive(Clone, Debug)]
pub struct BagInfo {
    /// Files and their sizes in bytes.
    pub files: Vec<(String, u64)>,
    /// Whether every file has its proper end, and none is missing.
    pub complete: bool,
    /// Files that metadata.yaml names and that are not there.
    pub missing_files: Vec<String>,
    /// Distribution of ROS that recorded it; empty if unknown.
    pub ros_distro: String,
    /// The topics with the number of messages of each.
    pub topics: Vec<(Topic, u64)>,
    /// Times of the first and the last message; `None` if there is none.
    pub times: Option<(Stamp, Stamp)>,
    /// Messages as metadata.yaml says, if it is there.
    pub promised_messages: Option<u64>,
    /// Ticks of each servo, by topic.
    pub ticks: BTreeMap<String, TickCount>,
    /// The scenes that it holds: name and hash, and whether the hash fits.
    pub scenes: Vec<(String, String, bool)>,
    /// The configurations that it holds: program version and hash.
    pub configurations: Vec<(String, String)>,
    /// What could not be read.
    pub damage: Vec<Damage>,
    /// Messages of our types that could not be decoded.
    pub undecodable: u64,
}

/// The ticks on one topic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickCount {
    /// How many are there.
    pub found: u64,
    /// How many are missing between the first and the last.
    pub missing: u64,
    /// Lost on the way to the recorder, as the servo says.
    pub lost: u64,
}

impl BagInfo {
    /// Messages of all topics.
    #[must_use]
    pub fn messages(&self) -> u64 {
        self.topics.iter().map(|(_, n)| n).sum()
    }

    /// Reads the bag at `path`.
    ///
    /// # Errors
    /// If it cannot be opened; damage within is reported in the result.
    pub fn read(path: &Path) -> Result<Self, BagError> {
        let reader = BagReader::open(path)?;
        let name = |p: &Path| p.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let size = |p: &Path| std::fs::metadata(p).map_or(0, |m| m.len());
        let mut info = Self {
            files: reader.files().map(|f| (name(f), size(f))).collect(),
            complete: reader.is_complete(),
            missing_files: reader.missing_files(),
            ros_distro: reader.ros_distro().to_owned(),
            topics: reader.topics().iter().map(|t| (t.clone(), 0)).collect(),
            times: None,
            promised_messages: reader.promised_messages(),
            ticks: BTreeMap::new(),
            scenes: Vec::new(),
            configurations: Vec::new(),
            damage: Vec::new(),
            undecodable: 0,
        };
        let mut next: BTreeMap<usize, u64> = BTreeMap::new();
        let mut messages = reader.messages();
        for message in messages.by_ref() {
            info.topics[message.topic].1 += 1;
            let (first, last) = info.times.unwrap_or((message.stamp, message.stamp));
            info.times = Some((first.min(message.stamp), last.max(message.stamp)));
            let topic = &reader.topics()[message.topic];
            if info.look_into(topic, &message.data, next.entry(message.topic).or_insert(u64::MAX)).is_err() {
                info.undecodable += 1;
            }
        }
        info.damage = messages.damage().to_vec();
        Ok(info)
    }

    fn look_into(&mut self, topic: &Topic, data: &[u8], next: &mut u64) -> Result<(), BagError> {
        match topic.type_name.as_str() {
            TickBatch::NAME => {
                let batch: TickBatch = cdr::decode(data)?;
                let count = self.ticks.entry(topic.name.clone()).or_default();
                count.lost = count.lost.max(batch.lost);
                for tick in &batch.ticks {
                    count.found += 1;
                    count.missing += tick.sequence.saturating_sub(*next);
                    *next = tick.sequence.saturating_add(1);
                }
            }
            SceneDescription::NAME => {
                let scene: SceneDescription = cdr::decode(data)?;
                let fits = scene.digest() == scene.sha256;
                push_new(&mut self.scenes, (scene.name, scene.sha256, fits));
            }
            ServoConfiguration::NAME => {
                let configuration: ServoConfiguration = cdr::decode(data)?;
                push_new(&mut self.configurations, (configuration.version, configuration.sha256));
            }
            _ => {}
        }
        Ok(())
    }
}

fn push_new<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if !list.contains(&item) {
        list.push(item);
    }
}
