use crate::failure::Failure;
use crate::half_written::HalfWritten;
use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that appears whole or not at all: written under another name in the same folder, then renamed. What is there
/// already and is no ordinary file (a terminal, a pipe) or is the program's standard output is not replaced but written
/// to, once all is known.
pub struct AtomicFile {
    /// As the user calls it.
    path: PathBuf,
    place: Place,
    file: BufWriter<tempfile::NamedTempFile>,
    half: HalfWritten,
}

enum Place {
    /// The file's own path, behind all symbolic links.
    File(PathBuf),
    Device(File),
    StandardOutput,
}

impl Place {
    fn of(path: &Path) -> io::Result<Self> {
        let Ok(there) = path.metadata() else { return Ok(Self::File(path.to_owned())) };
        if is_standard_output(&there) {
            return Ok(Self::StandardOutput);
        }
        // A pipe or a deleted file behind /proc has no path by which it could be replaced.
        match path.canonicalize() {
            Ok(own) if there.is_file() => Ok(Self::File(own)),
            _ => OpenOptions::new().write(true).open(path).map(Self::Device),
        }
    }
}

/// `/dev/stdout` leads to a file when the shell redirects to one: replacing it would take what `>>` has kept.
#[cfg(unix)]
fn is_standard_output(there: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    Path::new("/dev/stdout").metadata().is_ok_and(|out| (out.dev(), out.ino()) == (there.dev(), there.ino()))
}

#[cfg(not(unix))]
fn is_standard_output(_: &Metadata) -> bool {
    false
}

impl AtomicFile {
    /// Opens the temporary file beside `path`. None of `inputs` is overwritten.
    pub fn create(path: &Path, inputs: &[&Path]) -> Result<Self, Failure> {
        if path.is_dir() {
            return Err(Failure::file(path, "is a folder, not a file to write"));
        }
        crate::outputs::spare(path, inputs)?;
        let place = Place::of(path).map_err(|e| Failure::unwritten(path, &e))?;
        let folder = match &place {
            Place::File(file) => {
                file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned()
            }
            Place::Device(_) | Place::StandardOutput => std::env::temp_dir(),
        };
        let file = tempfile::Builder::new()
            .prefix(".cspace-haptics-")
            .tempfile_in(folder)
            .map_err(|e| Failure::unwritten(path, &e))?;
        let half = HalfWritten::at(file.path());
        Ok(Self { path: path.to_owned(), place, file: BufWriter::with_capacity(1 << 16, file), half })
    }

    /// Adds text.
    pub fn write(&mut self, text: &str) -> Result<(), Failure> {
        self.file.write_all(text.as_bytes()).map_err(|e| Failure::unwritten(&self.path, &e))
    }

    /// The temporary file, for writers that open by name what they write.
    #[cfg(feature = "inspect")]
    pub fn temporary(&self) -> &Path {
        self.file.get_ref().path()
    }

    /// Puts the file in its place.
    pub fn finish(self) -> Result<(), Failure> {
        let Self { path, place, file, half: _half } = self;
        let bad = |e: io::Error| Failure::unwritten(&path, &e);
        let file = file.into_inner().map_err(|e| bad(e.into_error()))?;
        match place {
            Place::File(own) => put_in_place(file, &own).map_err(bad),
            Place::Device(mut device) => {
                io::copy(&mut file.reopen().map_err(bad)?, &mut device).map_err(bad)?;
                Ok(())
            }
            Place::StandardOutput => {
                let mut text = file.reopen().map_err(bad)?;
                let mut out = io::stdout().lock();
                match io::copy(&mut text, &mut out).and_then(|_| out.flush()) {
                    // A reader that has gone away (`| head`) has seen what it wanted.
                    Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(bad(e)),
                    _ => Ok(()),
                }
            }
        }
    }
}

fn put_in_place(file: tempfile::NamedTempFile, own: &Path) -> io::Result<()> {
    file.as_file().sync_all()?;
    // A temporary file is private to its owner; the result is an ordinary file.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = own.metadata().map_or(0o644, |m| m.permissions().mode() & 0o777);
        file.as_file().set_permissions(std::fs::Permissions::from_mode(mode))?;
    }
    file.persist(own)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_appears_before_the_end_and_all_of_it_then() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("o.csv");
        let mut file = AtomicFile::create(&path, &[]).unwrap();
        file.write("a\n").unwrap();
        assert!(!path.exists());
        drop(file);
        assert_eq!(folder.path().read_dir().unwrap().count(), 0);
        let mut file = AtomicFile::create(&path, &[]).unwrap();
        file.write("a\nb\n").unwrap();
        file.finish().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "a\nb\n");
        assert_eq!(folder.path().read_dir().unwrap().count(), 1);
    }

    #[test]
    fn reasons_name_the_users_file_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("none").join("o.csv");
        let reason = AtomicFile::create(&path, &[]).err().unwrap().to_string();
        assert!(reason.starts_with(&format!("{}: cannot be written: No such file", path.display())), "{reason}");
        assert!(!reason.contains(".cspace-haptics-"), "{reason}");
    }

    #[test]
    fn what_is_read_is_not_overwritten_and_a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("o.csv"), folder.path().join("link.csv"));
        std::fs::write(&file, "in\n").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        assert!(AtomicFile::create(&link, &[&file]).is_err());
        let mut out = AtomicFile::create(&link, &[]).unwrap();
        out.write("out\n").unwrap();
        out.finish().unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "out\n");
        assert!(link.is_symlink());
    }

    #[test]
    fn a_device_is_written_to_and_stays_one() {
        // As root one would otherwise rename a file over it.
        let mut out = AtomicFile::create(Path::new("/dev/null"), &[]).unwrap();
        out.write("a\n").unwrap();
        out.finish().unwrap();
        assert!(!Path::new("/dev/null").is_file());
        let mut out = AtomicFile::create(Path::new("/dev/full"), &[]).unwrap();
        out.write("a\n").unwrap();
        assert!(out.finish().unwrap_err().to_string().starts_with("/dev/full: cannot be written: No space left"));
    }
}
