use crate::mcap_file::McapFile;
use crate::mcap_record::SchemaRecord;
use crate::metadata::{FileMetadata, Metadata, TopicMetadata};
use crate::msg::Message;
use crate::{BagError, Catalog, Qos, TypeDescription, cdr};
use spatial::Stamp;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How chunks are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// As they are.
    None,
    /// Zstandard at this level, 1 (fast) to 19.
    Zstd(i32),
}

/// How a bag is written.
#[derive(Clone, Debug)]
pub struct BagOptions {
    /// Compression of chunks.
    pub compression: Compression,
    /// A chunk is closed at this size, bytes.
    pub chunk_size: usize,
    /// A chunk is closed and written after this time at the latest: what a kill -9 can cost.
    pub flush_interval: Duration,
    /// A new file is begun after so many bytes; `None`: never.
    pub max_file_size: Option<u64>,
    /// A new file is begun after so much recorded time; `None`: never.
    pub max_file_duration: Option<Duration>,
    /// Free text for metadata.yaml, key and value.
    pub custom: Vec<(String, String)>,
    /// `ROS_DISTRO` for metadata.yaml; empty if recorded without ROS.
    pub ros_distro: String,
}

impl Default for BagOptions {
    fn default() -> Self {
        Self {
            compression: Compression::Zstd(1),
            chunk_size: 1 << 20,
            flush_interval: Duration::from_millis(400),
            max_file_size: None,
            // Every flush writes the file's chunk index anew; ten minutes keep it small.
            max_file_duration: Some(Duration::from_secs(600)),
            custom: Vec::new(),
            ros_distro: String::new(),
        }
    }
}

/// A topic of a [`BagWriter`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TopicId(usize);

/// Writes a rosbag2 directory. At any moment the folder is a complete bag that lacks at most the last
/// [`BagOptions::flush_interval`]: files and metadata.yaml are brought up to date at every flush.
#[derive(Debug)]
pub struct BagWriter {
    dir: PathBuf,
    options: BagOptions,
    topics: Vec<(TopicMetadata, SchemaRecord, u32)>,
    files: Vec<FileMetadata>,
    open: McapFile,
    /// Log time of the newest message, ns.
    newest: u64,
    flushed: Instant,
    finished: bool,
}

impl BagWriter {
    /// Begins a bag in the new folder `dir` (its parents are made if need be).
    ///
    /// # Errors
    /// If `dir` exists, or cannot be made or written to.
    pub fn create(dir: &Path, options: BagOptions) -> Result<Self, BagError> {
        if let Some(parent) = dir.parent() {
            std::fs::create_dir_all(parent).map_err(|e| BagError::io("cannot make the folder", parent, e))?;
        }
        std::fs::create_dir(dir).map_err(|e| match e.kind() {
            std::io::ErrorKind::AlreadyExists => BagError::Exists(dir.to_path_buf()),
            _ => BagError::io("cannot make the bag's folder", dir, e),
        })?;
        let open = McapFile::create(&dir.join(file_name(dir, 0)), options.compression)?;
        let writer = Self {
            dir: dir.to_path_buf(),
            options,
            topics: Vec::new(),
            files: Vec::new(),
            open,
            newest: 0,
            flushed: Instant::now(),
            finished: false,
        };
        writer.metadata().write(dir)?;
        Ok(writer)
    }

    /// The bag's folder.
    #[must_use]
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Adds a topic of any type. The same name and type again give the same topic.
    ///
    /// # Errors
    /// If the topic is there with another type, or there are too many of them.
    pub fn add_topic(&mut self, name: &str, description: &TypeDescription, qos: &[Qos]) -> Result<TopicId, BagError> {
        if let Some(i) = self.topics.iter().position(|(t, ..)| t.name == name) {
            let known = &self.topics[i].0.type_name;
            if *known == description.name {
                return Ok(TopicId(i));
            }
            let reason = format!("topic {name} is recorded as {known} already");
            return Err(BagError::message(&description.name, reason));
        }
        if self.topics.len() >= usize::from(u16::MAX) - 1 {
            return Err(BagError::format(&self.dir, "more topics than a bag can hold"));
        }
        let topic = TopicMetadata {
            name: name.to_owned(),
            type_name: description.name.clone(),
            qos: qos.to_vec(),
            hash: description.hash.clone(),
            count: 0,
        };
        let schema = SchemaRecord {
            id: 0,
            name: description.name.clone(),
            encoding: "ros2msg".to_owned(),
            text: description.schema.clone(),
        };
        self.topics.push((topic, schema, 0));
        let (topic, schema, _) = &self.topics[self.topics.len() - 1];
        add_to(&mut self.open, topic, schema);
        Ok(TopicId(self.topics.len() - 1))
    }

    /// Adds a topic of a type that this crate knows.
    ///
    /// # Errors
    /// See [`BagWriter::add_topic`].
    pub fn add<M: Message>(&mut self, name: &str, qos: &[Qos]) -> Result<TopicId, BagError> {
        let description = Catalog::built_in().describe(M::NAME)?;
        self.add_topic(name, &description, qos)
    }

    /// Records a message of `topic` that came in at `stamp`: CDR with its four-byte header. Should the clock step back, the
    /// log time stands still until it has caught up, so that readers that sort by it keep the order; the publish time is
    /// `stamp` in any case.
    ///
    /// # Errors
    /// If a flush was due and failed. The message is kept and the flush is tried again with the next one.
    pub fn write(&mut self, topic: TopicId, stamp: Stamp, cdr: &[u8]) -> Result<(), BagError> {
        // MCAP has unsigned times; nothing is recorded before 1970.
        let publish_time = u64::try_from(stamp.0).unwrap_or(0);
        let time = publish_time.max(self.newest);
        self.newest = time;
        let too_long = match (self.options.max_file_duration, self.open.times()) {
            (Some(most), Some((first, _))) => u128::from(time.saturating_sub(first)) >= most.as_nanos(),
            _ => false,
        };
        if too_long || self.options.max_file_size.is_some_and(|most| self.open.size() >= most && self.open.count() > 0)
        {
            self.split()?;
        }
        let (metadata, _, sequence) = &mut self.topics[topic.0];
        self.open.push(topic.0, *sequence, time, publish_time, cdr);
        metadata.count += 1;
        *sequence = sequence.wrapping_add(1);
        if self.open.pending_size() >= self.options.chunk_size { self.flush() } else { self.poll() }
    }

    /// Records a message that this crate knows.
    ///
    /// # Errors
    /// See [`BagWriter::write`].
    pub fn write_message<M: Message>(&mut self, topic: TopicId, stamp: Stamp, message: &M) -> Result<(), BagError> {
        self.write(topic, stamp, &cdr::encode(message)?)
    }

    /// Flushes if it is time to. To be called regularly while no messages come.
    ///
    /// # Errors
    /// If the flush failed.
    pub fn poll(&mut self) -> Result<(), BagError> {
        if self.flushed.elapsed() >= self.options.flush_interval { self.flush() } else { Ok(()) }
    }

    /// Brings the files up to date: afterwards nothing written so far is lost, even by a kill -9.
    ///
    /// # Errors
    /// If the system refuses (full disk); what was flushed before stays a complete bag.
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.flushed = Instant::now();
        if self.open.pending_size() == 0 {
            return Ok(());
        }
        self.open.flush()?;
        self.metadata().write(&self.dir)
    }

    /// Ends the bag and waits until it has reached the disk.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn finish(mut self) -> Result<(), BagError> {
        self.finished = true;
        self.open.finish()?;
        self.metadata().write(&self.dir)
    }

    fn split(&mut self) -> Result<(), BagError> {
        self.open.finish()?;
        let path = self.dir.join(file_name(&self.dir, self.files.len() + 1));
        let mut next = McapFile::create(&path, self.options.compression)?;
        for (topic, schema, _) in &self.topics {
            add_to(&mut next, topic, schema);
        }
        self.files.push(file_metadata(&self.open));
        self.open = next;
        self.metadata().write(&self.dir)
    }

    fn metadata(&self) -> Metadata {
        let mut files = self.files.clone();
        files.push(file_metadata(&self.open));
        let mut custom = vec![("cspace_haptics_version".to_owned(), env!("CARGO_PKG_VERSION").to_owned())];
        custom.extend(self.options.custom.iter().cloned());
        Metadata {
            topics: self.topics.iter().map(|(t, ..)| t.clone()).collect(),
            files,
            custom,
            ros_distro: self.options.ros_distro.clone(),
        }
    }
}

impl Drop for BagWriter {
    fn drop(&mut self) {
        if !self.finished {
            // Best effort on the way out of an error; `finish` reports.
            let _ = self.flush();
        }
    }
}

fn add_to(file: &mut McapFile, topic: &TopicMetadata, schema: &SchemaRecord) {
    let mut qos = String::new();
    topic.qos.iter().for_each(|q| qos.push_str(&q.yaml_item(0)));
    let metadata = vec![("offered_qos_profiles".to_owned(), qos), ("topic_type_hash".to_owned(), topic.hash.clone())];
    file.add_channel(&topic.name, schema.clone(), metadata);
}

fn file_metadata(file: &McapFile) -> FileMetadata {
    let name = file.path().file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    FileMetadata { name, times: file.times(), count: file.count() }
}

/// As rosbag2 names them: folder, underscore, number.
fn file_name(dir: &Path, n: usize) -> String {
    let stem = dir.file_name().map_or_else(|| "bag".into(), |n| n.to_string_lossy());
    format!("{stem}_{n}.mcap")
}
