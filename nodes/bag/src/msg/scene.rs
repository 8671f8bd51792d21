use super::Header;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

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

impl SceneDescription {
    /// A scene from its name, its text and the files that it names, in frame `frame_id`; the hash is worked out.
    #[must_use]
    pub fn new(
        name: &str,
        frame_id: &str,
        yaml: &str,
        files: impl IntoIterator<Item = (impl Into<String>, impl Into<Vec<u8>>)>,
    ) -> Self {
        let files = files.into_iter().map(|(path, data)| SceneFile { path: path.into(), data: data.into() }).collect();
        let mut scene = Self {
            header: Header { frame_id: frame_id.to_owned(), ..Header::default() },
            name: name.to_owned(),
            sha256: String::new(),
            yaml: yaml.to_owned(),
            files,
        };
        scene.sha256 = scene.digest();
        scene
    }

    /// The hash that `sha256` should hold.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut hash = Sha256::new();
        let parts = std::iter::once(("", self.yaml.as_bytes()))
            .chain(self.files.iter().map(|f| (f.path.as_str(), &f.data[..])));
        for (path, bytes) in parts {
            hash.update(path.as_bytes());
            hash.update((bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        }
        hex(&hash.finalize())
    }
}

impl ServoConfiguration {
    /// The configuration `yaml` for `scene`, by this version of the program, in frame `frame_id`.
    #[must_use]
    pub fn new(scene: &str, frame_id: &str, yaml: &str) -> Self {
        Self {
            header: Header { frame_id: frame_id.to_owned(), ..Header::default() },
            scene: scene.to_owned(),
            sha256: hex(&Sha256::digest(yaml.as_bytes())),
            yaml: yaml.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            record_version: servo::TickRecord::VERSION,
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}
