//! What builds and installs the nodes as a ROS package: cargo-ament-build, and colcon's extension that calls it.

use crate::progress::Step;
use crate::workspace;
use anyhow::Result;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

const CARGO_AMENT_BUILD: &str = "0.1.11";
const COLCON_MODULES: [&str; 4] =
    ["colcon-ros-cargo==0.2.0", "colcon-cargo==0.2.0", "colcon-package-information==0.4.1", "toml==0.10.2"];

/// Where the two are.
pub struct Packaging {
    /// Goes on the `PYTHONPATH` of colcon.
    pub modules: PathBuf,
    /// Goes on the `PATH` of cargo.
    pub programs: PathBuf,
}

/// Brings both into the cache.
pub fn bring() -> Result<Packaging> {
    Ok(Packaging { modules: colcon_modules()?, programs: cargo_ament_build()?.join("bin") })
}

fn cargo_ament_build() -> Result<PathBuf> {
    let root = workspace::cache()?.join(format!("cargo-ament-build-{CARGO_AMENT_BUILD}"));
    once(&root, "cargo-ament-build (cargo install)", || {
        let mut command = crate::cargo_build::cargo();
        // It copies files: nothing to optimise.
        command.args(["install", "--locked", "--debug", "--root"]).arg(&root);
        command.arg(format!("cargo-ament-build@{CARGO_AMENT_BUILD}"));
        command
    })?;
    Ok(root)
}

/// Beside the ROS, not in it: with another prefix r2r would make its bindings anew.
fn colcon_modules() -> Result<PathBuf> {
    let tools = super::bring_python_tools()?;
    let folder = workspace::cache()?.join(format!("colcon-{}", workspace::digest(COLCON_MODULES.map(str::as_bytes))));
    once(&folder, "colcon-ros-cargo from PyPI", || {
        let mut pip = Command::new(tools.join("bin/python"));
        pip.args(["-I", "-m", "pip", "install", "--disable-pip-version-check", "--no-deps", "--upgrade", "--target"]);
        pip.arg(&folder).args(COLCON_MODULES);
        pip
    })?;
    Ok(folder)
}

/// Runs what fills `folder` unless it has been run to its end before.
fn once(folder: &std::path::Path, name: &str, make: impl FnOnce() -> Command) -> Result<()> {
    let stamp = folder.join("complete");
    if stamp.is_file() {
        return Ok(());
    }
    let _held = workspace::lock(folder, || eprintln!("... another process is bringing {name}; waiting"))?;
    if stamp.is_file() {
        return Ok(());
    }
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    let step = Step::begin(name);
    step.run(&mut make(), &folder.with_added_extension("log"))?;
    fs::write(&stamp, "")?;
    step.done();
    Ok(())
}
