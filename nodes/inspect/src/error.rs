use rerun::sink::SinkFlushError;
use std::path::PathBuf;

/// Why a recording could not be made.
#[derive(Debug, thiserror::Error)]
pub enum InspectError {
    /// The file cannot be written.
    #[error("{}: cannot write the recording: {reason}", path.display())]
    File {
        /// The file asked for.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The viewer's address is not one.
    #[error("{address}: not a viewer's address ({reason}); write HOST:PORT or rerun+http://HOST:PORT/proxy")]
    Address {
        /// The address asked for.
        address: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The viewer or the disk did not take everything in time.
    #[error("{sink}: the recording was not taken in time ({reason}); the end of it may be missing")]
    Flush {
        /// File or address.
        sink: String,
        /// What rerun said.
        reason: String,
    },
    /// The disk or the viewer took no more.
    #[error("{sink}: the recording was cut short ({reason}): is the disk full, or the viewer gone?")]
    Cut {
        /// File or address.
        sink: String,
        /// What rerun said.
        reason: String,
    },
    /// No thread for the recording.
    #[error("inspect: cannot start a thread: {reason}")]
    Thread {
        /// What the system said.
        reason: String,
    },
    /// rerun refused the data: an error in this crate.
    #[error("rerun: {0}")]
    Log(#[from] rerun::RecordingStreamError),
}

impl InspectError {
    pub(crate) fn flush(sink: String, error: &SinkFlushError) -> Self {
        let reason = error.to_string();
        match error {
            SinkFlushError::Timeout => Self::Flush { sink, reason },
            SinkFlushError::Failed { .. } => Self::Cut { sink, reason },
        }
    }
}
