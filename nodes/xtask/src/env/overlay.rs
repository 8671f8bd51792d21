//! Our message package, built by colcon on a ROS 2 and kept in the cache.

use super::{Ros, Variables};
use crate::progress::Step;
use crate::workspace::{self, files_below};
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};

/// Builds `msgs/` if this state of it was not yet built on this ROS, and returns the variables of both.
pub fn bring(cache: &Path, ros: &Ros) -> Result<Variables> {
    let source = workspace::root().join("msgs");
    if !source.join("package.xml").is_file() {
        bail!("{}: no package.xml; the messages are missing", source.display());
    }
    let mut parts = vec![ros.identity.clone().into_bytes()];
    for file in files_below(&source)? {
        parts.push(file.strip_prefix(&source)?.to_string_lossy().into_owned().into_bytes());
        parts.push(fs::read(&file).with_context(|| format!("{}: cannot read", file.display()))?);
    }
    // The build scripts of r2r look at the prefix path: a new key makes them generate anew.
    let overlay = cache.join(format!("msgs-{}", workspace::digest(parts.iter().map(Vec::as_slice))));
    let stamp = overlay.join("complete");
    if !stamp.is_file() {
        let _held = workspace::lock(&overlay, || eprintln!("... another process is building the messages; waiting"))?;
        if !stamp.is_file() {
            build(&source, &overlay, ros)?;
            fs::write(&stamp, "")?;
        }
    }
    let install = overlay.join("install");
    let mut variables = ros.variables.clone();
    variables.prepend("AMENT_PREFIX_PATH", &install);
    variables.prepend("CMAKE_PREFIX_PATH", &install);
    variables.prepend("LD_LIBRARY_PATH", &install.join("lib"));
    for folder in python_folders(&install) {
        variables.prepend("PYTHONPATH", &folder);
    }
    Ok(variables)
}

fn build(source: &Path, overlay: &Path, ros: &Ros) -> Result<()> {
    if overlay.exists() {
        fs::remove_dir_all(overlay)
            .with_context(|| format!("{}: cannot remove what an interrupted run left", overlay.display()))?;
    }
    fs::create_dir_all(overlay)?;
    let step = Step::begin("messages (colcon)");
    let colcon = find_on_path(&ros.variables, "colcon").context("colcon: not found on the PATH")?;
    let cmake = find_on_path(&ros.variables, "cmake").context("cmake: not found on the PATH")?;
    let mut command = ros.variables.command(colcon);
    command
        .current_dir(overlay)
        .env("CMAKE_COMMAND", cmake)
        .env("COLCON_HOME", overlay.join("colcon"))
        .args(["--log-base", "log", "build", "--merge-install", "--base-paths"])
        .arg(source)
        .args(["--build-base", "build", "--install-base", "install", "--event-handlers", "console_direct+"])
        .args(["--cmake-args", "-DBUILD_TESTING=OFF", "-DCMAKE_BUILD_TYPE=Release"]);
    // The interpreter that CMake finds must be the one whose packages generate the code.
    if let Some(python) = find_on_path(&ros.variables, "python3") {
        command.arg(format!("-DPython3_EXECUTABLE={}", python.display()));
    }
    step.run(&mut command, &overlay.join("build.log"))?;
    let index = overlay.join("install/share/ament_index/resource_index/packages/cspace_haptics_msgs");
    if !index.is_file() {
        bail!(
            "colcon built no package cspace_haptics_msgs from {}; see {}",
            source.display(),
            overlay.join("build.log").display()
        );
    }
    step.done();
    Ok(())
}

fn find_on_path(variables: &Variables, program: &str) -> Option<PathBuf> {
    let path = variables.get("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file())
}

/// Where the install step puts Python modules: CMake and Debian's Python differ.
fn python_folders(install: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for base in ["lib", "local/lib"] {
        let Ok(entries) = fs::read_dir(install.join(base)) else { continue };
        for entry in entries.flatten() {
            if entry.file_name().to_string_lossy().starts_with("python3") {
                found.extend(
                    ["site-packages", "dist-packages"]
                        .map(|name| entry.path().join(name))
                        .into_iter()
                        .filter(|path| path.is_dir()),
                );
            }
        }
    }
    found.sort();
    found
}
