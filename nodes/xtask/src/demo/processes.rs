//! The demo's processes: up together, watched, and down in the order that loses nothing.

use super::child::Family;
use super::{Arguments, Output};
use crate::cargo_build::Executables;
use crate::env::Variables;
use crate::progress::Step;
use anyhow::{Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::net::SocketAddrV4;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long the processes may take to come up and to find one another.
const READY: Duration = Duration::from_secs(60);
/// How long a process may take to end.
const END: Duration = Duration::from_secs(20);
/// What the recorder says when ticks arrive.
const HEARS_TICKS: &str = "/ticks";

/// All that the processes are started from.
pub struct Processes<'a> {
    pub arguments: &'a Arguments,
    pub executables: &'a Executables,
    pub variables: &'a Variables,
    pub scene: &'a Path,
    pub domain: u16,
    pub output: &'a Output,
    pub viewer: Option<SocketAddrV4>,
}

/// What the servo and the recorder said about the run at its end.
pub struct Report {
    /// Last lines of every process, `name: text`.
    pub lines: Vec<String>,
    /// Somebody asked for an early end.
    pub interrupted: bool,
}

impl Processes<'_> {
    /// Runs from start to stop.
    ///
    /// # Errors
    /// A process could not start, did not get ready or died: its name and its last words.
    pub fn run(&self, stop: &AtomicBool) -> Result<Report> {
        let mut family = Family::new();
        let step = Step::begin(format!("servo, recorder and inspect on ROS domain {}", self.domain));
        // Listeners first, so that they miss as little as can be.
        let recorder = family.start("haptic_recorder", &self.recorder()?)?;
        let inspect = family.start("haptic_inspect", &self.inspect()?)?;
        let servo = family.start("haptic_servo", &self.servo()?)?;
        let begun = Instant::now();
        loop {
            let waiting: Vec<String> = family.children.iter().filter(|c| !c.ready).map(|c| c.name.clone()).collect();
            let hears = family.children[recorder].said.iter().any(|line| line.contains(HEARS_TICKS));
            if waiting.is_empty() && hears {
                break;
            }
            step.detail(&if waiting.is_empty() {
                "recorder looks for ticks".to_owned()
            } else {
                format!("waiting for {}", waiting.join(", "))
            });
            self.check(&mut family)?;
            if stop.load(Ordering::Relaxed) {
                self.end(&mut family, [servo, recorder, inspect]);
                bail!("stopped before everything was up");
            }
            if begun.elapsed() > READY {
                let who = if waiting.is_empty() {
                    "haptic_recorder hears no ticks".to_owned()
                } else {
                    format!("{} not ready", waiting.join(", "))
                };
                bail!("{who} after {} s", READY.as_secs());
            }
            family.listen_for(Duration::from_millis(100));
        }
        step.done();
        // From here on the bag holds something.
        self.output.keep();
        let interrupted = self.watch(&mut family, stop)?;
        let step = Step::begin("stopping");
        self.end(&mut family, [servo, recorder, inspect]);
        for child in &family.children {
            if let Some(status) = child.status()
                && !status.success()
            {
                bail!("{} did not end well: {}", child.name, child.last_words());
            }
        }
        step.done();
        let lines =
            family.children.iter().flat_map(|c| c.said.iter().map(move |line| format!("{}: {line}", c.name))).collect();
        Ok(Report { lines, interrupted })
    }

    /// Lets the time pass; true if somebody asked for the end.
    fn watch(&self, family: &mut Family, stop: &AtomicBool) -> Result<bool> {
        let duration = Duration::from_secs_f64(self.arguments.duration);
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(duration.as_millis() as u64);
            let style = "running {bar:40} {elapsed} of {prefix}  (Ctrl-C ends it)";
            bar.set_style(ProgressStyle::with_template(style).expect("a valid template"));
            bar.set_prefix(format!("{} s", self.arguments.duration));
            bar
        });
        if bar.is_none() {
            eprintln!("... running for {} s", self.arguments.duration);
        }
        let begun = Instant::now();
        let outcome = loop {
            let elapsed = begun.elapsed();
            if elapsed >= duration {
                break Ok(false);
            }
            if stop.load(Ordering::Relaxed) {
                break Ok(true);
            }
            if let Err(error) = self.check(family) {
                break Err(error);
            }
            if let Some(bar) = &bar {
                bar.set_position(elapsed.as_millis() as u64);
            }
            family.listen_for((duration - elapsed).min(Duration::from_millis(100)));
        };
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
        outcome
    }

    /// Whether all live. One that died takes the demo with it: the others end cleanly first.
    fn check(&self, family: &mut Family) -> Result<()> {
        let Some(dead) = family.dead() else { return Ok(()) };
        let name = family.children[dead].name.clone();
        let words = family.children[dead].last_words();
        let id = family.children[dead].id();
        let others: Vec<usize> = (0..family.children.len()).rev().collect();
        for child in others {
            family.stop(child, END);
        }
        if self.output.is_kept() {
            bail!("{name} (process {id}) died: {words}; what was recorded is in {}", self.output.folder().display());
        }
        bail!("{name}: {words}")
    }

    fn end(&self, family: &mut Family, order: [usize; 3]) {
        for child in order {
            family.stop(child, END);
        }
    }

    fn node(&self, name: &str) -> Result<Command> {
        let mut command = self.variables.local_command(self.executables.get(name)?, self.domain);
        command.current_dir(self.output.folder()).arg("--ros-args");
        Ok(command)
    }

    fn servo(&self) -> Result<Command> {
        let mut command = self.node("haptic_servo")?;
        command.arg("--params-file").arg(crate::workspace::root().join("config/haptic_servo.param.yaml"));
        set(&mut command, "scene", &self.scene.display());
        set(&mut command, "device.driver", &self.arguments.device);
        set(&mut command, "enabled", &true);
        for parameter in &self.arguments.param {
            command.args(["-p", parameter]);
        }
        Ok(command)
    }

    fn recorder(&self) -> Result<Command> {
        let mut command = self.node("haptic_recorder")?;
        set(&mut command, "output", &self.output.bag().display());
        Ok(command)
    }

    fn inspect(&self) -> Result<Command> {
        let mut command = self.node("haptic_inspect")?;
        set(&mut command, "scene", &self.scene.display());
        set(&mut command, "output", &self.output.recording().display());
        if let Some(address) = self.viewer {
            set(&mut command, "viewer", &true);
            set(&mut command, "address", &address);
        }
        Ok(command)
    }
}

fn set(command: &mut Command, name: &str, value: &dyn std::fmt::Display) {
    command.arg("-p").arg(format!("{name}:={value}"));
}
