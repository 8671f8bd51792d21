use crate::msg::{Header, Message, SceneDescription, ServoConfiguration, TickBatch};
use crate::{BagError, BagOptions, BagReader, BagWriter, Damage, Messages, Qos, cdr, tick_from_msg, tick_to_msg};
use servo::TickRecord;
use std::collections::VecDeque;
use std::path::Path;
use std::time::Duration;

/// The ticks that one message of an offline bag carries.
const BATCH: usize = 20;

/// A recorded run of a servo, whole.
#[derive(Clone, Debug, Default)]
pub struct TickLog {
    /// The scene it ran with, if the bag holds it.
    pub scene: Option<SceneDescription>,
    /// The configuration it ran with; the last one, if it was changed.
    pub configuration: Option<ServoConfiguration>,
    /// The ticks in the order of their sequence numbers.
    pub ticks: Vec<TickRecord>,
    /// Ticks that are missing between the first and the last.
    pub missing: u64,
    /// What of the bag could not be read.
    pub damage: Vec<Damage>,
}

/// Reads the ticks of the bag in `dir`. `topic` chooses between several servos; `None` if there is one.
///
/// # Errors
/// If the bag cannot be opened, holds no ticks or those of several servos, or ticks of a version that is not known here.
pub fn read_ticks(dir: &Path, topic: Option<&str>) -> Result<TickLog, BagError> {
    let reader = BagReader::open(dir)?;
    let mut ticks = Ticks::new(&reader, topic)?;
    let mut log = TickLog::default();
    for tick in ticks.by_ref() {
        log.ticks.push(tick?);
    }
    log.missing = ticks.missing();
    log.scene = ticks.scene.take();
    log.configuration = ticks.configuration.take();
    log.damage = ticks.damage().to_vec();
    Ok(log)
}

/// The ticks of a bag one by one, so that a long bag needs little memory.
pub struct Ticks<'a> {
    messages: Messages<'a>,
    reader: &'a BagReader,
    topic: usize,
    queue: VecDeque<TickRecord>,
    next: Option<u64>,
    missing: u64,
    /// The scene, once it was met; recorders put it before the ticks.
    pub scene: Option<SceneDescription>,
    /// The newest configuration that was met.
    pub configuration: Option<ServoConfiguration>,
}

impl<'a> Ticks<'a> {
    /// The ticks of `reader`'s bag, see [`read_ticks`].
    ///
    /// # Errors
    /// If there are none, or those of several servos and no choice.
    pub fn new(reader: &'a BagReader, topic: Option<&str>) -> Result<Self, BagError> {
        let candidates = reader.topics_of(TickBatch::NAME);
        let names = || candidates.iter().map(|&i| reader.topics()[i].name.as_str()).collect::<Vec<_>>().join(", ");
        let wanted = |i: &usize| topic.is_none_or(|t| reader.topics()[*i].name == t);
        let fail = |reason: String| Err(BagError::format(reader.path(), reason));
        let chosen: Vec<usize> = candidates.iter().copied().filter(wanted).collect();
        let topic = match chosen[..] {
            [one] => one,
            [] if candidates.is_empty() => return fail(reader.absent(&[TickBatch::NAME])),
            [] => {
                return fail(format!("no ticks on {}; choose one of {} (--topic)", topic.unwrap_or_default(), names()));
            }
            _ => return fail(format!("the bag has the ticks of several servos; choose one of {} (--topic)", names())),
        };
        Ok(Self {
            messages: reader.messages(),
            reader,
            topic,
            queue: VecDeque::new(),
            next: None,
            missing: 0,
            scene: None,
            configuration: None,
        })
    }

    /// The first scene of the servo whose ticks these are, wherever it stands in the bag.
    #[must_use]
    pub fn find_scene(&self) -> Option<SceneDescription> {
        self.find(SceneDescription::NAME)
    }

    /// The first configuration of the servo whose ticks these are, wherever it stands in the bag.
    #[must_use]
    pub fn find_configuration(&self) -> Option<ServoConfiguration> {
        self.find(ServoConfiguration::NAME)
    }

    fn find<M: Message>(&self, type_name: &str) -> Option<M> {
        let topics = self.reader.topics_of(type_name);
        let wanted: Vec<usize> = topics.into_iter().filter(|&t| self.is_of_same_node(t)).collect();
        if wanted.is_empty() {
            return None;
        }
        self.reader.messages().filter(|m| wanted.contains(&m.topic)).find_map(|m| cdr::decode(&m.data).ok())
    }

    /// The stamped configurations of the servo whose ticks these are, in the order in which they came into force.
    #[must_use]
    pub fn find_configurations(&self) -> Vec<ServoConfiguration> {
        let topics = self.reader.topics_of(ServoConfiguration::NAME);
        let wanted: Vec<usize> = topics.into_iter().filter(|&t| self.is_of_same_node(t)).collect();
        if wanted.is_empty() {
            return Vec::new();
        }
        self.reader.messages().filter(|m| wanted.contains(&m.topic)).filter_map(|m| cdr::decode(&m.data).ok()).collect()
    }

    /// Ticks missing between those that came so far.
    #[must_use]
    pub fn missing(&self) -> u64 {
        self.missing
    }

    /// What could not be read, once the ticks have run out.
    #[must_use]
    pub fn damage(&self) -> &[Damage] {
        self.messages.damage()
    }

    /// The node whose ticks these are: the topic without its last part.
    fn is_of_same_node(&self, topic: usize) -> bool {
        let node = |i: usize| self.reader.topics()[i].name.rsplit_once('/').map(|(node, _)| node);
        node(topic) == node(self.topic)
    }

    fn take_batch(&mut self, data: &[u8]) -> Result<(), BagError> {
        let batch: TickBatch = cdr::decode(data)?;
        if batch.version != TickRecord::VERSION {
            let reason = format!(
                "ticks of layout version {}, this program reads version {}; use the program that recorded them",
                batch.version,
                TickRecord::VERSION
            );
            return Err(BagError::format(self.reader.path(), reason));
        }
        for tick in &batch.ticks {
            let tick = tick_from_msg(tick)?;
            let sequence = tick.input.sequence;
            match self.next {
                // A servo that was started anew counts from 0 again.
                Some(next) if sequence > next => self.missing += sequence - next,
                _ => {}
            }
            self.next = Some(sequence.wrapping_add(1));
            self.queue.push_back(tick);
        }
        Ok(())
    }
}

impl Iterator for Ticks<'_> {
    type Item = Result<TickRecord, BagError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(tick) = self.queue.pop_front() {
                return Some(Ok(tick));
            }
            let message = self.messages.next()?;
            let type_name = &self.reader.topics()[message.topic].type_name;
            if message.topic == self.topic {
                if let Err(e) = self.take_batch(&message.data) {
                    return Some(Err(e));
                }
            } else if type_name == SceneDescription::NAME && self.is_of_same_node(message.topic) {
                self.scene = cdr::decode(&message.data).ok().or(self.scene.take());
            } else if type_name == ServoConfiguration::NAME && self.is_of_same_node(message.topic) {
                self.configuration = cdr::decode(&message.data).ok().or(self.configuration.take());
            }
        }
    }
}

/// Writes a bag with the scene, the configuration and the ticks, on the topics of a node called `haptic_servo`.
///
/// # Errors
/// If `dir` exists or cannot be written.
pub fn write_ticks<'t>(
    dir: &Path,
    scene: &SceneDescription,
    configuration: &ServoConfiguration,
    ticks: impl IntoIterator<Item = &'t TickRecord>,
) -> Result<(), BagError> {
    let mut writer = TickWriter::create(dir, scene, configuration)?;
    ticks.into_iter().try_for_each(|t| writer.push(t))?;
    writer.finish()
}

/// Writes ticks into a bag one by one, see [`write_ticks`].
#[derive(Debug)]
pub struct TickWriter {
    bag: BagWriter,
    topic: crate::TopicId,
    scene: Option<SceneDescription>,
    configuration: Option<ServoConfiguration>,
    batch: TickBatch,
}

impl TickWriter {
    /// Begins a bag in the new folder `dir`.
    ///
    /// # Errors
    /// If `dir` exists or cannot be written.
    pub fn create(dir: &Path, scene: &SceneDescription, configuration: &ServoConfiguration) -> Result<Self, BagError> {
        // Chunks end by their size alone, so that the same ticks give the same bytes however long it takes.
        let options = BagOptions { flush_interval: Duration::MAX, ..BagOptions::default() };
        let mut bag = BagWriter::create(dir, options)?;
        let topic = bag.add::<TickBatch>("/haptic_servo/ticks", &[Qos::RELIABLE])?;
        let header = Header { frame_id: "world".to_owned(), ..Header::default() };
        let batch = TickBatch {
            header,
            version: TickRecord::VERSION,
            child_frame_id: "tool".to_owned(),
            ..TickBatch::default()
        };
        Ok(Self { bag, topic, scene: Some(scene.clone()), configuration: Some(configuration.clone()), batch })
    }

    /// Adds a tick.
    ///
    /// # Errors
    /// If the bag cannot be written.
    pub fn push(&mut self, tick: &TickRecord) -> Result<(), BagError> {
        self.put_front_matter(tick.input.stamp)?;
        self.batch.ticks.push(tick_to_msg(tick));
        if self.batch.ticks.len() >= BATCH { self.put_batch() } else { Ok(()) }
    }

    /// Ends the bag.
    ///
    /// # Errors
    /// If the bag cannot be written.
    pub fn finish(mut self) -> Result<(), BagError> {
        self.put_front_matter(spatial::Stamp::default())?;
        self.put_batch()?;
        self.bag.finish()
    }

    /// Scene and configuration, stamped like the first tick.
    fn put_front_matter(&mut self, stamp: spatial::Stamp) -> Result<(), BagError> {
        if let Some(mut scene) = self.scene.take() {
            scene.header.stamp = stamp.into();
            let topic = self.bag.add::<SceneDescription>("/haptic_servo/scene", &[Qos::LATCHED])?;
            self.bag.write_message(topic, stamp, &scene)?;
        }
        if let Some(mut configuration) = self.configuration.take() {
            configuration.header.stamp = stamp.into();
            let topic = self.bag.add::<ServoConfiguration>("/haptic_servo/configuration", &[Qos::LATCHED])?;
            self.bag.write_message(topic, stamp, &configuration)?;
        }
        Ok(())
    }

    fn put_batch(&mut self) -> Result<(), BagError> {
        let Some(last) = self.batch.ticks.last() else { return Ok(()) };
        self.batch.header.stamp = last.stamp;
        self.bag.write_message(self.topic, last.stamp.into(), &self.batch)?;
        self.batch.ticks.clear();
        Ok(())
    }
}
