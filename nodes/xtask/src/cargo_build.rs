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

/// Builds the nodes and the offline program in the profile that the tests use too.
pub fn nodes(variables: &Variables) -> Result<Executables> {
    let step = Step::begin("nodes (cargo build)");
    let mut command = cargo();
    variables.apply(&mut command).args([
        "build",
        "-p",
        "cspace_haptics",
        "-p",
        "cli",
        "--bins",
        "--message-format",
        "json-render-diagnostics",
    ]);
    let mut found = BTreeMap::new();
    let log = workspace::cache()?.join("build.log");
    let _ = std::fs::remove_file(&log);
    step.run_reading(&mut command, &log, |line| {
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
