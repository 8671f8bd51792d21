//! `cargo xtask bench`: the benchmarks of every crate that has some.

use crate::cargo_build::cargo;
use crate::workspace;
use anyhow::{Context, Result, bail};
use std::fs;
use std::process::ExitCode;

/// What to measure.
#[derive(clap::Args)]
pub struct Arguments {
    /// Only benchmarks whose name contains this text
    filter: Option<String>,
}

/// Runs the benchmarks one crate after the other, so that they do not disturb one another.
///
/// # Errors
/// A benchmark fails.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let nodes = workspace::root().join("nodes");
    let mut crates: Vec<_> = fs::read_dir(&nodes)
        .with_context(|| format!("{}: cannot read the folder", nodes.display()))?
        .flatten()
        // The nodes need ROS to be sourced, and have nothing to measure that the servo has not.
        .filter(|entry| entry.path().join("benches").is_dir() && entry.file_name() != "ros")
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    crates.sort();
    for name in &crates {
        eprintln!("\n=== {name}");
        let mut command = cargo();
        command.args(["bench", "-p", name, "--bench", "*", "--"]).args(&arguments.filter);
        let status = command.status().context("cargo: cannot be started")?;
        if !status.success() {
            bail!("the benchmarks of {name} failed ({status})");
        }
    }
    Ok(ExitCode::SUCCESS)
}
