//! The folder that a demo leaves.

use anyhow::{Context, Result};
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// `out/<scene>-<time>`; dropped without [`Output::keep`], it is removed: nothing half-written stays.
pub struct Output {
    folder: PathBuf,
    keep: Cell<bool>,
}

impl Output {
    /// Makes a folder that did not exist.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn create(out: &Path, scene: &str) -> Result<Self> {
        fs::create_dir_all(out).with_context(|| format!("{}: cannot create the folder", out.display()))?;
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
        let name = format!("{scene}-{}", utc(seconds));
        // Two demos may begin in the same second.
        for count in 1.. {
            let folder = out.join(if count == 1 { name.clone() } else { format!("{name}-{count}") });
            match fs::create_dir(&folder) {
                Ok(()) => return Ok(Self { folder, keep: Cell::new(false) }),
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(error) => {
                    return Err(error).with_context(|| format!("{}: cannot create the folder", folder.display()));
                }
            }
        }
        unreachable!("the loop ends by returning")
    }

    /// What it holds is worth keeping, whatever happens now.
    pub fn keep(&self) {
        self.keep.set(true);
    }

    /// Whether it stays.
    pub fn is_kept(&self) -> bool {
        self.keep.get()
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The bag's folder in it.
    pub fn bag(&self) -> PathBuf {
        self.folder.join("bag")
    }

    /// The recording for rerun in it.
    pub fn recording(&self) -> PathBuf {
        self.folder.join("demo.rrd")
    }

    /// The summary in it.
    pub fn summary(&self) -> PathBuf {
        self.folder.join("summary.txt")
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        if !self.keep.get() {
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

/// `YYYYMMDD-hhmmss` of seconds since 1970, UTC (civil date from a day count, proleptic Gregorian calendar).
fn utc(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // Days since 1 March of year 0, so that the leap day ends a year.
    let day = days + 719_468;
    let era = day / 146_097;
    let of_era = day % 146_097;
    let year_of_era = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * of_year + 2) / 153;
    let date = of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}{month:02}{date:02}-{:02}{:02}{:02}", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_around_leap_days() {
        assert_eq!(utc(0), "19700101-000000");
        assert_eq!(utc(951_782_399), "20000228-235959");
        assert_eq!(utc(951_782_400), "20000229-000000");
        assert_eq!(utc(1_709_251_200), "20240301-000000");
        assert_eq!(utc(1_735_689_599), "20241231-235959");
    }

    #[test]
    fn what_is_not_kept_is_removed() {
        let base = std::env::temp_dir().join(format!("cspace-haptics-output-{}", std::process::id()));
        let first = Output::create(&base, "scene").unwrap();
        let second = Output::create(&base, "scene").unwrap();
        let (gone, stays) = (first.folder().to_owned(), second.folder().to_owned());
        assert_ne!(gone, stays);
        second.keep();
        drop((first, second));
        assert!(!gone.exists() && stays.exists());
        fs::remove_dir_all(base).unwrap();
    }
}
