//! `cargo xtask test`: everything that CI runs, step by step, to the end even when one fails.

use crate::cargo_build::{self, Profile, cargo};
use crate::env::{self, Variables};
use crate::{virtual_machine, workspace};
use anyhow::Result;
use std::process::{Command, ExitCode};
use std::time::Instant;

/// What to run.
#[derive(clap::Args)]
pub struct Arguments {
    /// Only the steps whose name contains this text
    #[arg(long)]
    only: Option<String>,
}

/// Runs the steps and says how many passed.
///
/// # Errors
/// The environment cannot be brought: nothing can be tested then.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let mut steps = Steps { only: arguments.only.as_deref(), passed: 0, skipped: Vec::new(), failed: Vec::new() };
    steps.run("rustfmt", cargo().args(["fmt", "--all", "--check"]));

    // From here on ROS is sourced throughout and every step takes the whole workspace: with other selections the
    // large dependencies would get other features and be compiled again.
    let variables = env::bring()?;
    cargo_build::settle_bindings(&variables)?;
    let with_ros = |arguments: &[&str]| {
        let mut command = cargo();
        variables.apply(&mut command).args(arguments);
        command
    };
    steps.run("clippy", &mut with_ros(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]));
    steps.run("rustdoc", with_ros(&["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"));
    steps.run_with("tests of the workspace", || {
        let mut command = with_ros(&["test", "--workspace", "--no-fail-fast"]);
        // rerun's own program looks at the recordings that the tests make.
        command.env("RERUN_CLI", crate::demo::viewer::program(&env::bring_python_tools()?)?);
        Ok(command)
    });
    steps.run_with("SpaceMouse on a virtual device", || Ok(virtual_machine::spacemouse_test()));
    steps.run_with("system tests on ROS 2", || system_tests(&variables));
    Ok(steps.conclude())
}

/// The Python programs that look at the nodes, the bags and the recordings from outside.
fn system_tests(variables: &Variables) -> Result<Command> {
    let executables = cargo_build::nodes(variables, Profile::Dev)?;
    let tools = env::bring_python_tools()?;
    let packaging = env::packaging::bring()?;
    let domain = crate::demo::domain::take(None)?;
    let mut command = variables.local_command("python3", domain.id);
    let tests = workspace::root().join("tests/python");
    command
        .current_dir(&tests)
        .args(["-m", "unittest", "discover", "-v", "-s"])
        .arg(&tests)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("PYTHONUNBUFFERED", "1")
        // A crash inside the middleware then says where.
        .env("PYTHONFAULTHANDLER", "1")
        .env("CSPACE_HAPTICS_BIN", executables.folder()?)
        .env("CSPACE_HAPTICS_ROOT", workspace::root())
        .env("CSPACE_HAPTICS_TOOLS", tools)
        .env("CSPACE_HAPTICS_COLCON", packaging.modules)
        .env("CSPACE_HAPTICS_CARGO_AMENT", packaging.programs);
    // Held until the end of this process, that is of all tests.
    std::mem::forget(domain);
    Ok(command)
}

/// The exit code by which a script says that it could not run here.
const SKIPPED: i32 = 77;

struct Steps<'a> {
    only: Option<&'a str>,
    passed: usize,
    skipped: Vec<String>,
    failed: Vec<String>,
}

impl Steps<'_> {
    fn run(&mut self, name: &str, command: &mut Command) {
        if !self.wanted(name) {
            return;
        }
        eprintln!("\n=== {name}");
        let begun = Instant::now();
        let outcome = command.status();
        let seconds = begun.elapsed().as_secs_f64();
        match outcome {
            Ok(status) if status.success() => {
                eprintln!("=== {name}: passed ({seconds:.0} s)");
                self.passed += 1;
            }
            Ok(status) if status.code() == Some(SKIPPED) => {
                eprintln!("=== {name}: SKIPPED, for the reason above");
                self.skipped.push(name.to_owned());
            }
            Ok(status) => self.fail(name, &status.to_string()),
            Err(error) => self.fail(name, &format!("{} cannot be started: {error}", command.get_program().display())),
        }
    }

    fn run_with(&mut self, name: &str, make: impl FnOnce() -> Result<Command>) {
        if !self.wanted(name) {
            return;
        }
        match make() {
            Ok(mut command) => self.run(name, &mut command),
            Err(error) => self.fail(name, &format!("{error:#}")),
        }
    }

    fn wanted(&self, name: &str) -> bool {
        self.only.is_none_or(|only| name.contains(only))
    }

    fn fail(&mut self, name: &str, reason: &str) {
        eprintln!("=== {name}: FAILED ({reason})");
        self.failed.push(name.to_owned());
    }

    fn conclude(self) -> ExitCode {
        eprintln!();
        for name in &self.failed {
            println!("failed: {name}");
        }
        for name in &self.skipped {
            println!("skipped: {name}");
        }
        println!("{} passed, {} failed, {} skipped", self.passed, self.failed.len(), self.skipped.len());
        if self.failed.is_empty() && self.passed > 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}
