use crate::failure::Failure;
use crate::half_written::HalfWritten;
use bag::BagError;
use bag::msg::{SceneDescription, ServoConfiguration};
use scene::Scene;
use servo::{Config, TickRecord};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A bag that appears whole or not at all: written into a folder beside its place, then moved there.
pub struct BagOut {
    temporary: tempfile::TempDir,
    name: OsString,
    dir: PathBuf,
    _half: HalfWritten,
}

impl BagOut {
    /// Writes the bag for the new folder `dir`.
    pub fn write(dir: &Path, scene: &Scene, config: &Config, records: &[TickRecord]) -> Result<Self, Failure> {
        if dir.symlink_metadata().is_ok() {
            return Err(Failure::plain(BagError::Exists(dir.to_owned())));
        }
        let name = dir.file_name().ok_or_else(|| Failure::file(dir, "is no name for a new folder"))?.to_owned();
        let parent = match dir.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        let bad = |e: std::io::Error| Failure::unwritten(dir, &e);
        std::fs::create_dir_all(parent).map_err(bad)?;
        let temporary = tempfile::Builder::new().prefix(".cspace-haptics-").tempdir_in(parent).map_err(bad)?;
        let half = HalfWritten::at(temporary.path());
        let files = scene.bundle.files.iter().map(|(path, data)| (path.clone(), data.clone()));
        let description = SceneDescription::new(&scene.name, &config.frame_id, &scene.bundle.yaml, files);
        let configuration = ServoConfiguration::new(&scene.name, &config.frame_id, &config.to_yaml());
        let place = temporary.path().join(&name);
        bag::write_ticks(&place, &description, &configuration, records).map_err(|e| match e {
            // Nothing of it stays.
            BagError::Io { source, .. } => bad(source),
            other => Failure::plain(other).known_as(&place, dir),
        })?;
        Ok(Self { temporary, name, dir: dir.to_owned(), _half: half })
    }

    /// Puts the bag in its place.
    pub fn finish(self) -> Result<(), Failure> {
        std::fs::rename(self.temporary.path().join(&self.name), &self.dir)
            .map_err(|e| Failure::unwritten(&self.dir, &e))
    }
}
