use super::tick_count::TickCount;
use super::{LogClock, RecorderOptions};
use crate::{Failure, Host, Inbox, Outcome, qos};
use bag::msg::{Message, TickBatch};
use bag::{BagWriter, Catalog, Qos, TopicId};
use r2r::QosProfile;
use r2r::qos::{DurabilityPolicy, HistoryPolicy, ReliabilityPolicy};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A bag that is being recorded.
pub struct Recorder {
    options: RecorderOptions,
    catalog: Catalog,
    writer: BagWriter,
    topics: BTreeMap<String, Recorded>,
    passed_over: BTreeSet<String>,
    looked: Option<Instant>,
    ticks: TickCount,
    clock: LogClock,
}

struct Recorded {
    id: TopicId,
    inbox: Inbox<Vec<u8>>,
    count: u64,
    carries_ticks: bool,
}

/// What a recording came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The bag.
    pub output: PathBuf,
    /// Topics heard.
    pub topics: usize,
    /// Messages written.
    pub messages: u64,
    /// Ticks in them, and those that are missing in between.
    pub ticks: (u64, u64),
}

impl std::fmt::Display for Summary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (ticks, lost) = self.ticks;
        write!(
            f,
            "recorded {}: topics={} messages={} ticks={ticks} lost={lost}",
            self.output.display(),
            self.topics,
            self.messages
        )
    }
}

impl Recorder {
    /// How often the graph is searched for new topics.
    const LOOK: Duration = Duration::from_millis(100);

    /// Begins the bag.
    ///
    /// # Errors
    /// If the folder exists or cannot be written.
    pub fn create(options: RecorderOptions) -> Outcome<Self> {
        let prefixes = std::env::var_os("AMENT_PREFIX_PATH").unwrap_or_default();
        let catalog = Catalog::with_prefixes(std::env::split_paths(&prefixes));
        let writer =
            BagWriter::create(&options.output, options.bag.clone()).map_err(|e| Failure::new(e.to_string()))?;
        Ok(Self {
            options,
            catalog,
            writer,
            topics: BTreeMap::new(),
            passed_over: BTreeSet::new(),
            looked: None,
            ticks: TickCount::default(),
            clock: LogClock::default(),
        })
    }

    /// One turn: looks for new topics now and then, waits up to `timeout` for messages and writes them. True if
    /// anything came.
    ///
    /// # Errors
    /// If the bag cannot be written.
    pub fn turn(&mut self, host: &mut Host, timeout: Duration) -> Outcome<bool> {
        if self.looked.is_none_or(|t| t.elapsed() >= Self::LOOK) {
            self.looked = Some(Instant::now());
            self.look(host)?;
        }
        host.spin_once(timeout);
        let (now, stepped_back) = self.clock.at(host.now());
        if let Some(seconds) = stepped_back.filter(|s| *s > 1e-3) {
            host.warn(&format!("the clock went back by {seconds:.3} s; log times go on from where they were"));
        }
        let mut came = false;
        for (name, topic) in &mut self.topics {
            while let Some(bytes) = topic.inbox.take() {
                came = true;
                topic.count += 1;
                if topic.count == 1 {
                    host.say(&format!("recording {name}"));
                }
                if topic.carries_ticks
                    && let Ok(batch) = bag::cdr::decode::<TickBatch>(&bytes)
                {
                    self.ticks.add(name, &batch);
                }
                self.writer.write(topic.id, now, &bytes).map_err(|e| Failure::new(e.to_string()))?;
            }
        }
        self.writer.poll().map_err(|e| Failure::new(e.to_string()))?;
        Ok(came)
    }

    /// Ends the bag.
    ///
    /// # Errors
    /// If the system refuses the last bytes.
    pub fn finish(self) -> Outcome<Summary> {
        let summary = Summary {
            output: self.options.output.clone(),
            topics: self.topics.len(),
            messages: self.topics.values().map(|t| t.count).sum(),
            ticks: (self.ticks.ticks, self.ticks.lost),
        };
        self.writer.finish().map_err(|e| Failure::new(e.to_string()))?;
        Ok(summary)
    }

    fn look(&mut self, host: &mut Host) -> Outcome<()> {
        for (name, types) in host.node.get_topic_names_and_types()? {
            if self.topics.contains_key(&name) || self.passed_over.contains(&name) || !self.options.wants(&name) {
                continue;
            }
            let offers: Vec<QosProfile> =
                host.node.get_publishers_info_by_topic(&name, false)?.into_iter().map(|p| p.qos_profile).collect();
            let [kind] = types.as_slice() else {
                if !types.is_empty() {
                    self.pass_over(host, &name, &format!("it has several types: {}", types.join(", ")));
                }
                continue;
            };
            // Nobody speaks yet: what it will offer is not known either.
            if offers.is_empty() {
                continue;
            }
            if let Err(reason) = self.add(host, &name, kind, &offers) {
                self.pass_over(host, &name, &reason.to_string());
            }
        }
        Ok(())
    }

    fn add(&mut self, host: &mut Host, name: &str, kind: &str, offers: &[QosProfile]) -> Outcome<()> {
        let described = self.catalog.describe(kind).map_err(|e| Failure::new(e.to_string()))?;
        let inbox = Inbox::new(host.node.subscribe_raw(name, kind, qos::matching(offers))?);
        let offered: Vec<Qos> = offers.iter().map(bag_qos).collect();
        let id = self.writer.add_topic(name, &described, &offered).map_err(|e| Failure::new(e.to_string()))?;
        let carries_ticks = kind == TickBatch::NAME;
        self.topics.insert(name.to_owned(), Recorded { id, inbox, count: 0, carries_ticks });
        Ok(())
    }

    fn pass_over(&mut self, host: &Host, name: &str, reason: &str) {
        host.warn(&format!("topic {name} is not recorded: {reason}"));
        self.passed_over.insert(name.to_owned());
    }
}

fn bag_qos(offer: &QosProfile) -> Qos {
    Qos {
        keep_last: !matches!(offer.history, HistoryPolicy::KeepAll),
        // Discovery does not tell the depth of others; a player needs one.
        depth: u32::try_from(offer.depth).unwrap_or(u32::MAX).max(10),
        reliable: !matches!(offer.reliability, ReliabilityPolicy::BestEffort),
        transient_local: matches!(offer.durability, DurabilityPolicy::TransientLocal),
    }
}
