//! What the wheels of ROS 2 need after installation before C++, CMake and Rust can build on them. All of it may be
//! repeated without harm.

use super::python::Python;
use crate::progress::Step;
use crate::workspace::files_below;
use anyhow::{Context, Result, bail};
use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Raised with every change below, so that older prefixes are made anew.
pub const VERSION: u32 = 1;

/// Mends the prefix in place.
pub fn apply(prefix: &Path, python: &Python, step: &Step) -> Result<()> {
    step.detail("linking the middleware");
    link_middleware(prefix)?;
    step.detail("search paths of libraries");
    libraries(prefix, &python.site_packages(prefix))?;
    step.detail("paths in CMake files");
    cmake_paths(prefix, python)
}

/// The wheels hold no `librmw_implementation.so`, the switch between middlewares; there is but one of them.
fn link_middleware(prefix: &Path) -> Result<()> {
    let link = prefix.join("lib/librmw_implementation.so");
    if link.symlink_metadata().is_err() {
        symlink("librmw_fastrtps_cpp.so", &link).with_context(|| format!("{}: cannot link", link.display()))?;
    }
    Ok(())
}

fn is_library(path: &Path) -> bool {
    path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.ends_with(".so") || name.contains(".so."))
        && path.symlink_metadata().is_ok_and(|meta| meta.is_file())
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = fs::read_dir(folder).with_context(|| format!("{}: cannot read the folder", folder.display()))?;
    let mut entries = read.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

/// Every library finds its peers in `lib` and the ones bundled with the wheels in `*.libs`, and none but the Python
/// side needs a library with Python symbols.
fn libraries(prefix: &Path, site: &Path) -> Result<()> {
    let lib = prefix.join("lib");
    let own: Vec<PathBuf> = entries(&lib)?.into_iter().filter(|path| is_library(path)).collect();
    let names: BTreeSet<String> = own.iter().filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect();
    let bundles: Vec<PathBuf> = entries(site)?
        .into_iter()
        .filter(|path| {
            path.file_name().and_then(|n| n.to_str()).is_some_and(|n| n.starts_with("ros_") && n.ends_with(".libs"))
        })
        .collect();
    let mut search = lib.display().to_string();
    for bundle in &bundles {
        search = format!("{search}:{}", bundle.display());
    }
    let patchelf = Patchelf { program: prefix.join("bin/patchelf"), search };

    for library in &own {
        let is_python_side = library.to_string_lossy().ends_with("_generator_py.so");
        patchelf.mend(library, !is_python_side)?;
    }
    for bundle in &bundles {
        for library in entries(bundle)?.iter().filter(|path| is_library(path)) {
            patchelf.mend(library, false)?;
        }
    }
    for library in files_below(site)?.iter().filter(|path| is_library(path)) {
        let bundled = library.components().any(|part| part.as_os_str().to_string_lossy().ends_with(".libs"));
        if !bundled && patchelf.needed(library)?.iter().any(|name| names.contains(name)) {
            patchelf.mend(library, false)?;
        }
    }
    Ok(())
}

struct Patchelf {
    program: PathBuf,
    search: String,
}

impl Patchelf {
    fn needed(&self, library: &Path) -> Result<Vec<String>> {
        let output = self.run(Command::new(&self.program).arg("--print-needed").arg(library))?;
        Ok(output.lines().map(str::to_owned).collect())
    }

    fn mend(&self, library: &Path, drop_python: bool) -> Result<()> {
        let mut command = Command::new(&self.program);
        command.args(["--set-rpath", &self.search]);
        if drop_python {
            for name in self.needed(library)?.iter().filter(|name| name.ends_with("_generator_py.so")) {
                command.args(["--remove-needed", name]);
            }
        }
        self.run(command.arg(library)).map(drop)
    }

    fn run(&self, command: &mut Command) -> Result<String> {
        let output = command.output().with_context(|| format!("{}: cannot be started", self.program.display()))?;
        if !output.status.success() {
            bail!("patchelf: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }
}

/// The CMake files name the interpreter they were made with; ours stands elsewhere.
fn cmake_paths(prefix: &Path, python: &Python) -> Result<()> {
    let compact = python.version.replace('.', "");
    let made_with = format!("/opt/python/cp{compact}-cp{compact}");
    let pairs = [
        (format!("{made_with}/include/python{}", python.version), python.include.display().to_string()),
        (
            format!("{made_with}/lib/python{}/site-packages", python.version),
            python.site_packages(prefix).display().to_string(),
        ),
    ];
    for file in files_below(&prefix.join("share"))?.iter().filter(|path| path.extension().is_some_and(|e| e == "cmake"))
    {
        let Ok(text) = fs::read_to_string(file) else { continue };
        let mended = pairs.iter().fold(text.clone(), |text, (old, new)| text.replace(old, new));
        if mended != text {
            fs::write(file, mended).with_context(|| format!("{}: cannot write", file.display()))?;
        }
    }
    Ok(())
}
