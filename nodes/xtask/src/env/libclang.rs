//! libclang, which reads the C headers of ROS 2 when r2r is built.

use super::{Variables, python, system};
use crate::progress::Step;
use crate::workspace;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PYPI_VERSION: &str = "18.1.1";

/// Points the build at a libclang: the caller's, Debian's (installed when root), else the one of PyPI.
pub fn bring(cache: &Path, variables: &mut Variables) -> Result<()> {
    if std::env::var_os("LIBCLANG_PATH").is_some() {
        return Ok(());
    }
    let folder = match installed() {
        Some(folder) => folder,
        None if system::may_install() => {
            system::install(&["libclang-dev"], "r2r reads the headers of ROS 2 with it")?;
            installed().context("libclang: not found, even after installing libclang-dev")?
        }
        None => from_pypi(cache)?,
    };
    variables.set("LIBCLANG_PATH", folder.display());
    if !has_own_headers(&folder) && std::env::var_os("BINDGEN_EXTRA_CLANG_ARGS").is_none() {
        // Without the headers that belong to clang, the C compiler's own serve: stddef.h and its kind.
        let output = Command::new("cc").arg("-print-file-name=include").output().context("cc: cannot be started")?;
        variables.set("BINDGEN_EXTRA_CLANG_ARGS", format!("-I{}", String::from_utf8_lossy(&output.stdout).trim()));
    }
    Ok(())
}

fn folders() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = fs::read_dir("/usr/lib")
        .into_iter()
        .flatten()
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().starts_with("llvm"))
        .map(|entry| entry.path().join("lib"))
        .collect();
    folders.sort();
    folders.reverse();
    folders.extend(
        ["/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib64", "/usr/lib", "/usr/local/lib"]
            .map(PathBuf::from),
    );
    folders
}

fn installed() -> Option<PathBuf> {
    folders().into_iter().find(|folder| {
        fs::read_dir(folder).into_iter().flatten().flatten().any(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            name == "libclang.so"
                || name.starts_with("libclang.so.")
                || (name.starts_with("libclang-") && name.contains(".so") && !name.contains("cpp"))
        })
    })
}

fn has_own_headers(folder: &Path) -> bool {
    fs::read_dir(folder.join("clang"))
        .into_iter()
        .flatten()
        .flatten()
        .any(|entry| entry.path().join("include/stddef.h").is_file())
}

fn from_pypi(cache: &Path) -> Result<PathBuf> {
    let target = cache.join(format!("libclang-{PYPI_VERSION}"));
    let folder = target.join("clang/native");
    let stamp = target.join("complete");
    if stamp.is_file() {
        return Ok(folder);
    }
    let _held = workspace::lock(&target, || eprintln!("... another process is bringing libclang; waiting"))?;
    if !stamp.is_file() {
        let step = Step::begin("libclang from PyPI (Debian: libclang-dev)");
        if target.exists() {
            fs::remove_dir_all(&target)?;
        }
        // pip of a throw-away environment: the system's Python may have none.
        let venv = target.join("pip");
        let log = target.with_added_extension("log");
        step.run(Command::new(python::find()?.executable).args(["-m", "venv"]).arg(&venv), &log)?;
        let mut pip = Command::new(venv.join("bin/python"));
        pip.args([
            "-m",
            "pip",
            "install",
            "--disable-pip-version-check",
            "--no-deps",
            "--only-binary=:all:",
            "--upgrade",
            "--target",
        ]);
        step.run(pip.arg(&target).arg(format!("libclang=={PYPI_VERSION}")), &log)?;
        fs::remove_dir_all(&venv)?;
        fs::write(&stamp, "")?;
        step.done();
    }
    Ok(folder)
}
