//! What is half written goes when the program is interrupted: a temporary name is removed by who made it, or here.

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Temporary files and folders that exist now.
static PATHS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn paths() -> MutexGuard<'static, Vec<PathBuf>> {
    PATHS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file or folder, as long as this lives.
#[derive(Debug)]
pub struct HalfWritten(PathBuf);

impl HalfWritten {
    /// To be made as soon as the path exists, and to be dropped when it is in its place or removed.
    pub fn at(path: &Path) -> Self {
        paths().push(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for HalfWritten {
    fn drop(&mut self) {
        paths().retain(|p| *p != self.0);
    }
}

/// From now on an interrupt removes what is half written; the exit code is what a shell expects. A system that gives no
/// thread or no signals leaves it lying there.
pub fn remove_when_interrupted() {
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM, SIGHUP]) else { return };
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            // The lock is kept: nothing new begins until the end.
            for path in paths().iter() {
                let _ = std::fs::remove_file(path).or_else(|_| std::fs::remove_dir_all(path));
            }
            std::process::exit(128 + signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".into()).spawn(wait);
}
