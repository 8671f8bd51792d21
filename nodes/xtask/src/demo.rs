//! `cargo xtask demo`: the whole line on one machine, from a hand to a bag, a recording for rerun and a summary.

pub mod child;
pub mod domain;
mod output;
mod processes;
mod summary;
pub mod viewer;

use crate::cargo_build::{self, Executables, Profile};
use crate::env;
use crate::workspace;
use anyhow::{Context, Result, bail};
use output::Output;
use processes::Processes;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What to show and for how long.
#[derive(clap::Args)]
pub struct Arguments {
    /// Seconds to run once everything is up
    #[arg(long, default_value_t = 10.0, value_parser = seconds)]
    duration: f64,
    /// A folder of config/scenes
    #[arg(long, default_value = "peg_in_hole")]
    scene: String,
    /// The device in the hand
    #[arg(long, default_value = "simulated", value_parser = ["simulated", "spacemouse"])]
    device: String,
    /// Run the nodes as they are installed, for figures: another build of everything
    #[arg(long)]
    release: bool,
    /// Watch it in the rerun viewer too
    #[arg(long)]
    viewer: bool,
    /// A parameter of the servo, such as law:=proxy; may be repeated
    #[arg(long, value_name = "NAME:=VALUE", value_parser = parameter)]
    param: Vec<String>,
    /// ROS_DOMAIN_ID to use instead of a free one
    #[arg(long)]
    domain: Option<u16>,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.5..=86_400.0).contains(&value) => Ok(value),
        _ => Err("0.5 to 86400 seconds".to_owned()),
    }
}

fn parameter(text: &str) -> Result<String, String> {
    match text.split_once(":=") {
        Some((name, value)) if !name.is_empty() && !value.is_empty() => Ok(text.to_owned()),
        _ => Err("NAME:=VALUE".to_owned()),
    }
}

/// Runs the demo.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let scene = scene_file(&arguments.scene)?;
    let domain = domain::take(arguments.domain)?;
    let variables = env::bring()?;
    let profile = if arguments.release { Profile::Release } else { Profile::Dev };
    let executables = cargo_build::nodes(&variables, profile)?;
    check_scene(&executables, &scene)?;

    let stop = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).context("signals cannot be caught")?;
    }
    let viewer = if arguments.viewer { Some(viewer::Viewer::open()?) } else { None };
    let output = Output::create(&workspace::root().join("out"), &arguments.scene)?;
    let processes = Processes {
        arguments,
        executables: &executables,
        variables: &variables,
        scene: &scene,
        domain: domain.id,
        output: &output,
        viewer: viewer.as_ref().map(|viewer| viewer.address),
    };
    let report = processes.run(&stop)?;
    let code = summary::write(&executables, &variables, &output, arguments, &report)?;
    if let Some(viewer) = viewer
        && !report.interrupted
    {
        viewer.wait(&stop);
    }
    Ok(code)
}

/// The scene must be whole before anything is started.
fn check_scene(executables: &Executables, scene: &Path) -> Result<()> {
    let output = Command::new(executables.get("cspace-haptics")?).args(["scene", "check"]).arg(scene).output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let line = said.lines().rev().find_map(|line| line.strip_prefix("error: ")).unwrap_or("the scene check failed");
        bail!("{line}");
    }
    Ok(())
}

fn scene_file(name: &str) -> Result<PathBuf> {
    let scenes = workspace::root().join("config/scenes");
    let file = scenes.join(name).join("scene.yaml");
    // A name is one folder: not a path that leads elsewhere.
    if !name.contains('/') && file.is_file() {
        return Ok(file);
    }
    let mut known: Vec<String> = fs::read_dir(&scenes)
        .with_context(|| format!("{}: cannot read the folder", scenes.display()))?
        .flatten()
        .filter(|entry| entry.path().join("scene.yaml").is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    known.sort();
    bail!("--scene {name}: unknown; there are {}", known.join(", "))
}
