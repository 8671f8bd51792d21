//! A folder for the time of a run.

use anyhow::{Context, Result};
use std::fs::DirBuilder;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

/// A new folder that only we may read; removed with all it holds when dropped.
pub struct Temporary(PathBuf);

impl Temporary {
    /// Makes it.
    ///
    /// # Errors
    /// It cannot be made, or somebody was there first.
    pub fn create() -> Result<Self> {
        let path = std::env::temp_dir().join(format!("cspace-haptics-pictures-{}", std::process::id()));
        DirBuilder::new()
            .mode(0o700)
            .create(&path)
            .with_context(|| format!("{}: cannot create the folder", path.display()))?;
        Ok(Self(path))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
