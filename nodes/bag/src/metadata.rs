use crate::{BagError, Qos};
use serde::Deserialize;
use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::ErrorKind;
use std::os::unix::fs::FileExt;
use std::path::Path;

/// A topic of a bag as metadata.yaml has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicMetadata {
    /// Its name.
    pub name: String,
    /// `package/msg/Type`.
    pub type_name: String,
    /// Profiles that its publishers offered.
    pub qos: Vec<Qos>,
    /// `RIHS01_…`.
    pub hash: String,
    /// Messages recorded.
    pub count: u64,
}

/// A file of a bag as metadata.yaml has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileMetadata {
    /// File name within the folder.
    pub name: String,
    /// Log times of its first and last message, ns; `None` if it has none.
    pub times: Option<(u64, u64)>,
    /// Messages in it.
    pub count: u64,
}

/// metadata.yaml, version 9.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Metadata {
    pub(crate) topics: Vec<TopicMetadata>,
    pub(crate) files: Vec<FileMetadata>,
    pub(crate) custom: Vec<(String, String)>,
    pub(crate) ros_distro: String,
}

impl Metadata {
    pub(crate) fn to_yaml(&self) -> String {
        let times = self.files.iter().filter_map(|f| f.times).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (first, last) = times.unwrap_or((0, 0));
        let mut y = String::from("rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n");
        let _ = write!(
            y,
            "  duration:\n    nanoseconds: {}\n  starting_time:\n    nanoseconds_since_epoch: {first}\n  message_count: {}\n",
            last - first,
            self.files.iter().map(|f| f.count).sum::<u64>()
        );
        y.push_str(if self.topics.is_empty() {
            "  topics_with_message_count: []\n"
        } else {
            "  topics_with_message_count:\n"
        });
        for topic in &self.topics {
            let _ = write!(
                y,
                "    - topic_metadata:\n        name: {}\n        type: {}\n        serialization_format: cdr\n",
                quoted(&topic.name),
                quoted(&topic.type_name)
            );
            y.push_str(if topic.qos.is_empty() {
                "        offered_qos_profiles: []\n"
            } else {
                "        offered_qos_profiles:\n"
            });
            topic.qos.iter().for_each(|q| y.push_str(&q.yaml_item(10)));
            let _ = write!(
                y,
                "        type_description_hash: {}\n      message_count: {}\n",
                quoted(&topic.hash),
                topic.count
            );
        }
        y.push_str("  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n");
        for file in &self.files {
            let _ = writeln!(y, "    - {}", quoted(&file.name));
        }
        y.push_str("  files:\n");
        for file in &self.files {
            let (first, last) = file.times.unwrap_or((0, 0));
            let _ = write!(
                y,
                "    - path: {}\n      starting_time:\n        nanoseconds_since_epoch: {first}\n      duration:\n        nanoseconds: {}\n      message_count: {}\n",
                quoted(&file.name),
                last - first,
                file.count
            );
        }
        y.push_str(if self.custom.is_empty() { "  custom_data: ~\n" } else { "  custom_data:\n" });
        for (key, value) in &self.custom {
            let _ = writeln!(y, "    {}: {}", quoted(key), quoted(value));
        }
        let _ = writeln!(y, "  ros_distro: {}", quoted(&self.ros_distro));
        y
    }

    /// Writes metadata.yaml at once: a reader sees the old one or the new one, never half of it.
    pub(crate) fn write(&self, dir: &Path) -> Result<(), BagError> {
        let (path, new) = (dir.join("metadata.yaml"), dir.join("metadata.yaml.new"));
        let yaml = self.to_yaml();
        std::fs::write(&new, &yaml)
            .and_then(|()| std::fs::rename(&new, &path))
            .or_else(|e| {
                // Best effort: what is left of it only takes room.
                let _ = std::fs::remove_file(&new);
                // A disk with no room for a second file still has that of the first, which must count what was just flushed.
                if e.kind() == ErrorKind::StorageFull { overwrite(&path, &yaml) } else { Err(e) }
            })
            .map_err(|e| BagError::io("cannot write the bag's metadata", &path, e))
    }
}

/// Writes over an existing file within the room that it has.
fn overwrite(path: &Path, text: &str) -> std::io::Result<()> {
    let file = OpenOptions::new().write(true).open(path)?;
    file.write_all_at(text.as_bytes(), 0)?;
    file.set_len(text.len() as u64)
}

/// A YAML double-quoted scalar; JSON's escapes are a subset of YAML's.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// What the reader needs of anyone's metadata.yaml, whatever the version.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct ForeignMetadata {
    pub(crate) storage_identifier: String,
    pub(crate) compression_mode: String,
    pub(crate) compression_format: String,
    pub(crate) relative_file_paths: Vec<String>,
    pub(crate) ros_distro: String,
    pub(crate) message_count: u64,
}

impl ForeignMetadata {
    /// Reads metadata.yaml of `dir`; `None` if there is none or it is damaged: the files alone then tell.
    pub(crate) fn read(dir: &Path) -> Option<Self> {
        #[derive(Deserialize)]
        struct Document {
            rosbag2_bagfile_information: ForeignMetadata,
        }
        let text = std::fs::read_to_string(dir.join("metadata.yaml")).ok()?;
        serde_saphyr::from_str::<Document>(&text).ok().map(|d| d.rosbag2_bagfile_information)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overwriting_leaves_the_new_text_alone() {
        let path = std::env::temp_dir().join(format!("cspace-haptics-metadata-{}", std::process::id()));
        std::fs::write(&path, "a long text of before").unwrap();
        for text in ["shorter", "and a longer one than the one of before"] {
            overwrite(&path, text).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        }
        std::fs::remove_file(&path).unwrap();
    }
}
