use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Why a command ended with exit code 1: shown as one line, `FILE[:LINE]: reason`.
#[derive(Debug)]
pub struct Failure {
    file: Option<PathBuf>,
    line: Option<u64>,
    reason: String,
}

impl Failure {
    /// Something wrong with a file as a whole.
    pub fn file(file: impl AsRef<Path>, reason: impl fmt::Display) -> Self {
        Self { file: Some(file.as_ref().to_owned()), line: None, reason: reason.to_string() }
    }

    /// Something wrong in line `line` (from 1) of a file.
    #[allow(dead_code, reason = "not every feature set reads text files")]
    pub fn line(file: impl AsRef<Path>, line: u64, reason: impl fmt::Display) -> Self {
        Self { line: Some(line), ..Self::file(file, reason) }
    }

    /// An output that cannot be written. The user knows it by its own name, not by that of the temporary file.
    pub fn unwritten(file: impl AsRef<Path>, e: &std::io::Error) -> Self {
        let reason = e.to_string();
        let hint = match e.kind() {
            ErrorKind::NotFound => "; make its folder first",
            ErrorKind::StorageFull => "; free some space",
            ErrorKind::PermissionDenied => "; choose a folder that you may write to",
            _ => "",
        };
        Self::file(file, format!("cannot be written: {}{hint}", reason.split(" at path ").next().unwrap_or_default()))
    }

    /// The same of a file that the user knows as `shown`, not as the temporary one that it was written to.
    pub fn known_as(self, temporary: &Path, shown: &Path) -> Self {
        let rename = |text: &str| text.replace(&*temporary.to_string_lossy(), &shown.to_string_lossy());
        Self { file: self.file.map(|f| rename(&f.to_string_lossy()).into()), reason: rename(&self.reason), ..self }
    }

    /// A reason that names its file itself, or has none.
    #[allow(dead_code, reason = "not every feature set needs it")]
    pub fn plain(reason: impl fmt::Display) -> Self {
        Self { file: None, line: None, reason: reason.to_string() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}", one_line(&file.to_string_lossy()))?;
            if let Some(line) = self.line {
                write!(f, ":{line}")?;
            }
            f.write_str(": ")?;
        }
        f.write_str(&one_line(&self.reason))
    }
}

/// Libraries explain themselves over several lines; a script that reads ours wants one.
fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_one_line_with_file_and_line() {
        assert_eq!(Failure::line("a.csv", 7, "bad\n  number\n").to_string(), "a.csv:7: bad; number");
        assert_eq!(Failure::file("a.csv", "empty").to_string(), "a.csv: empty");
    }
}
