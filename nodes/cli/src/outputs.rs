//! What a command may write over: neither what it reads nor what else it writes.

use crate::failure::Failure;
use std::path::{Path, PathBuf};

/// Refuses an output that the command reads: one of `inputs`, or the data of a bag among them.
pub fn spare(out: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    let Ok(own) = out.canonicalize() else { return Ok(()) };
    let is_data = own.extension().is_some_and(|e| e == "mcap") || own.file_name().is_some_and(|n| n == "metadata.yaml");
    let is_read = |input: PathBuf| own == input || is_data && own.parent() == Some(&input);
    if inputs.iter().filter_map(|i| i.canonicalize().ok()).any(is_read) {
        return Err(Failure::file(out, "is read by this command: name another file to write"));
    }
    Ok(())
}

/// Refuses outputs two of which are one file: the later would replace the earlier.
pub fn tell_apart(outs: &[&Path]) -> Result<(), Failure> {
    // A terminal or /dev/null takes anything.
    let outs: Vec<&Path> = outs.iter().copied().filter(|p| !p.exists() || p.is_file() || p.is_dir()).collect();
    for (i, out) in outs.iter().enumerate() {
        if outs[..i].iter().any(|other| place(other) == place(out)) {
            return Err(Failure::file(out, "is to be written twice: name another file for one of them"));
        }
    }
    Ok(())
}

/// Where the path leads, though there may be nothing yet.
fn place(path: &Path) -> PathBuf {
    let whole = path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned());
    match (whole.parent().and_then(|p| p.canonicalize().ok()), whole.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => whole,
    }
}
