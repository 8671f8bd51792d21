use std::path::{Path, PathBuf};

/// Why a scene cannot be used: shown as `FILE[:LINE]: reason`, one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// The scene file or the mesh at fault.
    pub file: PathBuf,
    /// Line of a text file, from 1.
    pub line: Option<u64>,
    /// What is wrong.
    pub reason: String,
}

impl SceneError {
    pub(crate) fn new(file: impl AsRef<Path>, line: Option<u64>, reason: impl std::fmt::Display) -> Self {
        // Parsers explain themselves over several lines.
        let reason = reason.to_string();
        let reason = reason.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join("; ");
        Self { file: file.as_ref().to_owned(), line, reason }
    }
}

impl std::fmt::Display for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.reason)
    }
}

impl std::error::Error for SceneError {}
