use std::path::{Path, PathBuf};

/// Why a bag could not be written or read: one line that says what, where and what to do.
#[derive(Debug, thiserror::Error)]
pub enum BagError {
    /// The operating system refused (permission, full disk, missing file).
    #[error("{}: {action}: {source}{}", path.display(), hint(source))]
    Io {
        /// What was being done.
        action: &'static str,
        /// To which file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The folder for a new bag exists already.
    #[error("{}: exists already; name a new folder for the bag", .0.display())]
    Exists(PathBuf),
    /// Not a bag, or one of a kind that is not read here.
    #[error("{}: {reason}", path.display())]
    Format {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong and what to do.
        reason: String,
    },
    /// A message that could not be turned into bytes or back.
    #[error("{type_name}: {reason}")]
    Message {
        /// The ROS type, `package/msg/Type`.
        type_name: String,
        /// What is wrong.
        reason: String,
    },
}

impl BagError {
    pub(crate) fn io(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Self::Io { action, path: path.to_path_buf(), source }
    }

    pub(crate) fn format(path: &Path, reason: impl Into<String>) -> Self {
        Self::Format { path: path.to_path_buf(), reason: reason.into() }
    }

    pub(crate) fn message(type_name: &str, reason: impl Into<String>) -> Self {
        Self::Message { type_name: type_name.to_owned(), reason: reason.into() }
    }
}

fn hint(e: &std::io::Error) -> &'static str {
    match e.kind() {
        std::io::ErrorKind::StorageFull => "; what was recorded so far is complete, free some space",
        std::io::ErrorKind::PermissionDenied => "; choose a folder that you may write to, or change its mode",
        _ => "",
    }
}
