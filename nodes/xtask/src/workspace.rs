//! Where things are: the repository and the cache.

use anyhow::{Context, Result};
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("nodes/xtask lies two below the root").to_path_buf()
}

/// The folder that survives `cargo clean`: `$XDG_CACHE_HOME`, else `~/.cache`, else `.cache` in the repository.
pub fn cache() -> Result<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = set("XDG_CACHE_HOME")
        .filter(|path| path.is_absolute())
        .or_else(|| set("HOME").map(|home| home.join(".cache")))
        .unwrap_or_else(|| root().join(".cache"));
    let cache = base.join("cspace-haptics");
    fs::create_dir_all(&cache).with_context(|| format!("{}: cannot create the cache", cache.display()))?;
    Ok(cache)
}

/// Holds a cache entry against other processes until dropped; the system releases it if we are killed.
pub struct Lock(#[expect(dead_code, reason = "held, not read")] File);

/// Waits for the lock of the cache entry at `path`; `waiting` is called once if another process holds it.
pub fn lock(path: &Path, waiting: impl FnOnce()) -> Result<Lock> {
    let path = path.with_added_extension("lock");
    let file = File::create(&path).with_context(|| format!("{}: cannot create the lock file", path.display()))?;
    if file.try_lock().is_err() {
        waiting();
        file.lock().with_context(|| format!("{}: cannot lock", path.display()))?;
    }
    Ok(Lock(file))
}

/// Twelve hex digits that name `parts`; each part is closed off, so that moving a border changes the name.
pub fn digest<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    hash.finalize().iter().take(6).map(|byte| format!("{byte:02x}")).collect()
}

/// The files below `folder`, sorted, without the ones that version control ignores by our own rules.
pub fn files_below(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).with_context(|| format!("{}: cannot read the folder", folder.display()))? {
            let entry = entry?;
            let kind = entry.file_type()?;
            if kind.is_dir() && entry.file_name() != "__pycache__" {
                open.push(entry.path());
            } else if kind.is_file() {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digest_tells_borders_apart() {
        assert_ne!(digest([b"ab".as_slice(), b"c"]), digest([b"a".as_slice(), b"bc"]));
        assert_eq!(digest([b"ab".as_slice()]).len(), 12);
    }

    #[test]
    fn root_holds_the_workspace() {
        assert!(root().join("nodes/xtask/Cargo.toml").is_file());
    }
}
