use super::Header;
use serde::{Deserialize, Serialize};

/// `cspace_haptics_msgs/msg/SceneFile`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneFile {
    /// Path as the scene has it, relative to the scene file.
    pub path: String,
    /// Its bytes.
    pub data: Vec<u8>,
}

/// `cspace_haptics_msgs/msg/SceneDescription`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneDescription {
    /// Stamp of publication; frame W.
    pub header: Header,
    /// Name of the scene.
    pub name: String,
    /// SHA-256 over yaml and files as 64 lower-case hexadecimal digits: for each of scene text, then every file in
    /// the order below its path, the length of its bytes as 8 bytes little-endian and the bytes; the scene text has
    /// an empty path.
    pub sha256: String,
    /// Text of scene.yaml.
    pub yaml: String,
    /// The mesh files that it names.
    pub files: Vec<SceneFile>,
}

/// `cspace_haptics_msgs/msg/ServoConfiguration`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ServoConfiguration {
    /// Stamp from which on it holds; frame_id is the world frame.
    pub header: Header,
    /// Name of the scene that it is used with.
    pub scene: String,
    /// SHA-256 of yaml as 64 lower-case hexadecimal digits.
    pub sha256: String,
    /// The parameter tree as YAML, as the offline program and the servo node read it.
    pub yaml: String,
    /// Version of the program that wrote it, for example "0.1.0".
    pub version: String,
    /// Layout version of the tick records that go with it, see TickRecord.
    pub record_version: u16,
}
