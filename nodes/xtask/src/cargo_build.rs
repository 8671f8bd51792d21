//! Builds executables with cargo and says where they are.

use crate::env::Variables;
use crate::progress::Step;
use crate::workspace;
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;

/// The cargo that runs us, in the root of the repository.
pub fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(workspace::root());
    command
}

/// Makes r2r's bindings anew when they were made for another ROS.
///
/// r2r's build script keeps the bindings of every environment that it has seen, but tells rustc which messages there are
/// only when it makes them: after a change of ROS and back, parts of its API would be missing.
///
/// # Errors
/// The target folder cannot be written.
pub fn settle_bindings(variables: &Variables) -> Result<()> {
    let watched = ["AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "ROS_DISTRO"];
    let identity = watched.map(|name| format!("{name}={}\n", variables.get(name).unwrap_or_default())).concat();
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace::root().join("target"), PathBuf::from);
    let stamp = target.join("ros-of-bindings");
    if std::fs::read_to_string(&stamp).is_ok_and(|known| known == identity) {
        return Ok(());
    }
    let packages = ["-p", "r2r", "-p", "r2r_rcl", "-p", "r2r_msg_gen", "-p", "r2r_actions"];
    for profile in ["dev", "release"] {
        let mut clean = cargo();
        clean.args(["clean", "--quiet", "--profile", profile]).args(packages);
        let status = clean.status().context("cargo clean cannot be started")?;
        anyhow::ensure!(status.success(), "cargo clean of r2r's bindings failed ({status})");
    }
    std::fs::create_dir_all(&target)
        .and_then(|()| std::fs::write(&stamp, identity))
        .with_context(|| format!("{} cannot be written", stamp.display()))
}

/// The executables of a build, by name.
pub struct Executables(BTreeMap<String, PathBuf>);

impl Executables {
    /// Where one is.
    ///
    /// # Errors
    /// The build made none of that name.
    pub fn get(&self, name: &str) -> Result<&PathBuf> {
        self.0.get(name).with_context(|| format!("the build made no executable `{name}`"))
    }

    /// The folder that holds them.
    ///
    /// # Errors
    /// The build made none.
    pub fn folder(&self) -> Result<PathBuf> {
        Ok(self.get("haptic_servo")?.parent().context("an executable in no folder")?.to_owned())
    }
}

/// How the nodes are compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// As the tests have it, so that the large dependencies are built once.
    Dev,
    /// As they are installed: for figures.
    Release,
}

/// Builds the nodes and the offline program.
///
/// # Errors
/// The build fails.
pub fn nodes(variables: &Variables, profile: Profile) -> Result<Executables> {
    settle_bindings(variables)?;
    let mut command = cargo();
    variables.apply(&mut command).args(["build", "-p", "cspace_haptics", "-p", "cli", "--bins"]);
    if profile == Profile::Release {
        command.arg("--release");
    }
    build("nodes", &mut command)
}

/// Builds the offline program alone, which needs no ROS.
pub fn offline() -> Result<Executables> {
    build("offline program", cargo().args(["build", "-p", "cli", "--bins"]))
}

fn build(what: &str, command: &mut Command) -> Result<Executables> {
    let step = Step::begin(format!("{what} (cargo build)"));
    command.args(["--message-format", "json-render-diagnostics"]);
    let mut found = BTreeMap::new();
    let log = workspace::cache()?.join("build.log");
    let _ = std::fs::remove_file(&log);
    step.run_reading(command, &log, |line| {
        // Cargo's messages are one object a line; what else is printed is for people.
        if !line.starts_with('{') {
            return false;
        }
        if let Ok(message) = serde_json::from_str::<serde_json::Value>(line)
            && let Some(path) = message["executable"].as_str()
            && let Some(name) = message["target"]["name"].as_str()
        {
            found.insert(name.to_owned(), PathBuf::from(path));
        }
        true
    })?;
    step.done();
    Ok(Executables(found))
}
