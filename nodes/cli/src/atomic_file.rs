use crate::failure::Failure;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that appears whole or not at all: written under another name in the same folder, then renamed.
pub struct AtomicFile {
    path: PathBuf,
    file: BufWriter<tempfile::NamedTempFile>,
}

impl AtomicFile {
    /// Opens the temporary file beside `path`.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        if path.is_dir() {
            return Err(Failure::file(path, "is a folder, not a file to write"));
        }
        let folder = match path.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        let file = tempfile::Builder::new()
            .prefix(".cspace-haptics-")
            .tempfile_in(folder)
            .map_err(|e| Failure::file(path, format!("cannot be written: {e}")))?;
        Ok(Self { path: path.to_owned(), file: BufWriter::with_capacity(1 << 16, file) })
    }

    /// Adds text.
    pub fn write(&mut self, text: &str) -> Result<(), Failure> {
        self.file.write_all(text.as_bytes()).map_err(|e| Failure::file(&self.path, format!("cannot be written: {e}")))
    }

    /// Puts the file in its place.
    pub fn finish(self) -> Result<(), Failure> {
        let Self { path, file } = self;
        let bad = |e: &dyn std::fmt::Display| Failure::file(&path, format!("cannot be written: {e}"));
        let file = file.into_inner().map_err(|e| bad(&e.error()))?;
        file.as_file().sync_all().map_err(|e| bad(&e))?;
        // A temporary file is private to its owner; the result is an ordinary file.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = path.metadata().map_or(0o644, |m| m.permissions().mode() & 0o777);
            file.as_file().set_permissions(std::fs::Permissions::from_mode(mode)).map_err(|e| bad(&e))?;
        }
        file.persist(&path).map_err(|e| bad(&e.error))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_appears_before_the_end_and_all_of_it_then() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("o.csv");
        let mut file = AtomicFile::create(&path).unwrap();
        file.write("a\n").unwrap();
        assert!(!path.exists());
        drop(file);
        assert_eq!(folder.path().read_dir().unwrap().count(), 0);
        let mut file = AtomicFile::create(&path).unwrap();
        file.write("a\nb\n").unwrap();
        file.finish().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "a\nb\n");
        assert_eq!(folder.path().read_dir().unwrap().count(), 1);
    }
}
