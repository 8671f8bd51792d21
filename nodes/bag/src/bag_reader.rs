use crate::BagError;
use crate::mcap_record::{ChannelRecord, SchemaRecord};
use crate::mcap_scan::{Damage, Found, McapScan, summary_is_sound};
use crate::metadata::ForeignMetadata;
use spatial::Stamp;
use std::collections::HashMap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// A topic of a bag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Its name.
    pub name: String,
    /// `package/msg/Type`; empty if the schema was lost.
    pub type_name: String,
    /// The definition as text.
    pub schema: String,
    /// How the definition is written: `ros2msg` or `ros2idl`.
    pub schema_encoding: String,
    /// `RIHS01_…`, empty if the bag does not say.
    pub hash: String,
    /// The offered profiles as the YAML text that the bag has.
    pub qos: String,
}

/// A message of a bag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BagMessage {
    /// Position in [`BagReader::topics`].
    pub topic: usize,
    /// When it was recorded.
    pub stamp: Stamp,
    /// CDR with its four-byte header.
    pub data: Vec<u8>,
}

/// Reads rosbag2 directories of MCAP files, whoever wrote them, as far as they are intact.
#[derive(Debug)]
pub struct BagReader {
    dir: PathBuf,
    files: Vec<BagFile>,
    topics: Vec<Topic>,
    metadata: Option<ForeignMetadata>,
    unpack_messages: bool,
}

#[derive(Debug)]
struct BagFile {
    path: PathBuf,
    name: String,
    file: File,
    /// Channel to topic.
    channels: HashMap<u16, usize>,
    complete: bool,
}

impl BagReader {
    /// Opens a bag: its folder, or one .mcap file.
    ///
    /// # Errors
    /// If there is no such folder, no MCAP file in it, the bag is in another storage (sqlite3) or compressed as a whole.
    pub fn open(path: &Path) -> Result<Self, BagError> {
        let is_file = std::fs::metadata(path).map_err(|e| BagError::io("cannot open the bag", path, e))?.is_file();
        let metadata = if is_file { None } else { ForeignMetadata::read(path) };
        let paths = if is_file { vec![path.to_path_buf()] } else { list_files(path, metadata.as_ref())? };
        let unpack_messages = metadata.as_ref().is_some_and(|m| m.compression_mode.eq_ignore_ascii_case("message"));
        let mut reader =
            Self { dir: path.to_path_buf(), files: Vec::new(), topics: Vec::new(), metadata, unpack_messages };
        for path in paths {
            reader.add_file(path)?;
        }
        Ok(reader)
    }

    /// The folder or file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.dir
    }

    /// The files in the order in which they are read.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|f| f.path.as_path())
    }

    /// Whether every file has its proper beginning and end, and none is missing.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.files.iter().all(|f| f.complete) && self.missing_files().is_empty()
    }

    /// The files that metadata.yaml names and that are not there.
    #[must_use]
    pub fn missing_files(&self) -> Vec<String> {
        let named = self.metadata.iter().flat_map(|m| &m.relative_file_paths);
        let names = named.filter_map(|path| Some(Path::new(path).file_name()?.to_string_lossy().into_owned()));
        names.filter(|name| !self.dir.join(name).exists()).collect()
    }

    /// Distribution of ROS that recorded it, as metadata.yaml says; empty if it does not.
    #[must_use]
    pub fn ros_distro(&self) -> &str {
        self.metadata.as_ref().map_or("", |m| &m.ros_distro)
    }

    /// Messages as metadata.yaml says; `None` if it is missing or damaged.
    #[must_use]
    pub fn promised_messages(&self) -> Option<u64> {
        self.metadata.as_ref().map(|m| m.message_count)
    }

    /// The topics.
    #[must_use]
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The position of the topic that is called `name`.
    #[must_use]
    pub fn topic(&self, name: &str) -> Option<usize> {
        self.topics.iter().position(|t| t.name == name)
    }

    /// The positions of the topics of a type.
    #[must_use]
    pub fn topics_of(&self, type_name: &str) -> Vec<usize> {
        (0..self.topics.len()).filter(|&i| self.topics[i].type_name == type_name).collect()
    }

    /// Why there is nothing of these types: the bag has no such topic, or the file that had it is damaged.
    #[must_use]
    pub fn absent(&self, type_names: &[&str]) -> String {
        let mut messages = self.messages();
        messages.by_ref().for_each(drop);
        let reason = format!("the bag has no topic of {}", type_names.join(" or "));
        match messages.damage() {
            [] => reason,
            [d, ..] => format!("{reason}; damage: {} at byte {}: {}", d.file, d.offset, d.what),
        }
    }

    /// All messages, file by file, in the order of their times within a chunk.
    #[must_use]
    pub fn messages(&self) -> Messages<'_> {
        Messages { reader: self, file: 0, scan: None, damage: Vec::new() }
    }

    fn add_file(&mut self, path: PathBuf) -> Result<(), BagError> {
        let file = File::open(&path).map_err(|e| BagError::io("cannot open the bag's file", &path, e))?;
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let mut found = Channels::default();
        // The summary holds all channels of a finished file; in others they stand in the chunks.
        let mut quick = McapScan::new(&name, &file, false);
        quick.by_ref().for_each(|f| found.take(f));
        let complete = quick.is_complete() && summary_is_sound(&file);
        if !complete || found.channels.is_empty() {
            // What stands in chunks is under their checksums and comes first.
            found = Channels::default();
            McapScan::new(&name, &file, true).for_each(|f| found.take(f));
        }
        let channels = found.channels.iter().map(|c| (c.id, self.topic_of(c, &found.schemas))).collect();
        self.files.push(BagFile { path, name, file, channels, complete });
        Ok(())
    }

    fn topic_of(&mut self, channel: &ChannelRecord, schemas: &[SchemaRecord]) -> usize {
        let schema = schemas.iter().find(|s| s.id == channel.schema);
        let type_name = schema.map_or("", |s| s.name.as_str());
        if let Some(i) = self.topics.iter().position(|t| t.name == channel.topic && t.type_name == type_name) {
            return i;
        }
        let entry = |key: &str| {
            channel.metadata.iter().find(|(k, _)| k == key).map_or_else(String::new, |(_, value)| value.clone())
        };
        self.topics.push(Topic {
            name: channel.topic.clone(),
            type_name: type_name.to_owned(),
            schema: schema.map_or_else(String::new, |s| s.text.clone()),
            schema_encoding: schema.map_or_else(String::new, |s| s.encoding.clone()),
            hash: entry("topic_type_hash"),
            qos: entry("offered_qos_profiles"),
        });
        self.topics.len() - 1
    }
}

#[derive(Default)]
struct Channels {
    schemas: Vec<SchemaRecord>,
    channels: Vec<ChannelRecord>,
}

impl Channels {
    fn take(&mut self, found: Found) {
        match found {
            Found::Schema(s) if !self.schemas.iter().any(|k| k.id == s.id) => self.schemas.push(s),
            Found::Channel(c) if !self.channels.iter().any(|k| k.id == c.id) => self.channels.push(c),
            _ => {}
        }
    }
}

/// The messages of a bag, and what of it was damaged.
pub struct Messages<'a> {
    reader: &'a BagReader,
    file: usize,
    scan: Option<McapScan<'a>>,
    damage: Vec<Damage>,
}

impl Messages<'_> {
    /// What could not be read, once the messages have run out.
    #[must_use]
    pub fn damage(&self) -> &[Damage] {
        &self.damage
    }
}

impl Iterator for Messages<'_> {
    type Item = BagMessage;

    fn next(&mut self) -> Option<BagMessage> {
        loop {
            let file = self.reader.files.get(self.file)?;
            let scan = self.scan.get_or_insert_with(|| McapScan::new(&file.name, &file.file, true));
            match scan.next() {
                Some(Found::Message { channel, log_time, data }) => {
                    let Some(&topic) = file.channels.get(&channel) else { continue };
                    let data = if self.reader.unpack_messages { unpack(&data).unwrap_or(data) } else { data };
                    let stamp = Stamp(i64::try_from(log_time).unwrap_or(i64::MAX));
                    return Some(BagMessage { topic, stamp, data });
                }
                Some(_) => {}
                None => {
                    self.damage.extend(self.scan.take().into_iter().flat_map(McapScan::into_damage));
                    self.file += 1;
                }
            }
        }
    }
}

/// A message that rosbag2 has compressed by itself.
fn unpack(data: &[u8]) -> Option<Vec<u8>> {
    use std::io::Read;
    let mut out = Vec::new();
    zstd::stream::read::Decoder::with_buffer(data).ok()?.take(1 << 30).read_to_end(&mut out).ok()?;
    Some(out)
}

/// The bag's files in the order of their numbers: those that metadata.yaml names, and those that it does not know yet.
fn list_files(dir: &Path, metadata: Option<&ForeignMetadata>) -> Result<Vec<PathBuf>, BagError> {
    let mut mcap = Vec::new();
    let mut others = Vec::new();
    for entry in std::fs::read_dir(dir).map_err(|e| BagError::io("cannot read the folder", dir, e))? {
        let path = entry.map_err(|e| BagError::io("cannot read the folder", dir, e))?.path();
        match path.extension().and_then(|e| e.to_str()) {
            Some("mcap") => mcap.push(path),
            Some(other @ ("db3" | "zstd" | "bag")) => others.push(other.to_owned()),
            _ => {}
        }
    }
    if let Some(m) = metadata
        && !matches!(m.storage_identifier.as_str(), "mcap" | "")
    {
        let reason = format!(
            "the bag is stored as {}; only MCAP is read: convert it with `ros2 bag convert` or `rosbags-convert`",
            m.storage_identifier
        );
        return Err(BagError::format(dir, reason));
    }
    if mcap.is_empty() {
        let reason = match others.first().map(String::as_str) {
            Some("db3") => {
                "the bag is stored as sqlite3; only MCAP is read: convert it with `ros2 bag convert` or `rosbags-convert`"
            }
            Some("zstd") => {
                "the bag's files are compressed as a whole; unpack them with `zstd -d` and name them in metadata.yaml"
            }
            Some(_) => "this is a bag of ROS 1; only rosbag2 with MCAP is read: convert it with `rosbags-convert`",
            None => "there is no .mcap file in this folder, so it is no bag",
        };
        return Err(BagError::format(dir, reason));
    }
    let rank = |p: &Path| {
        metadata.and_then(|m| {
            m.relative_file_paths.iter().position(|f| p.ends_with(Path::new(f).file_name().unwrap_or_default()))
        })
    };
    mcap.sort_by_key(|p| (rank(p).unwrap_or(usize::MAX), natural_key(p)));
    Ok(mcap)
}

/// `bag_10.mcap` after `bag_9.mcap`.
fn natural_key(path: &Path) -> (String, u64) {
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    match stem.rsplit_once('_').map(|(head, n)| (head.to_owned(), n.parse())) {
        Some((head, Ok(n))) => (head, n),
        _ => (stem, 0),
    }
}
