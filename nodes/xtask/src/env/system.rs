//! Programs and packages of the operating system.

use crate::progress::Step;
use crate::workspace;
use anyhow::{Result, bail};
use std::path::PathBuf;
use std::process::Command;

/// The full path of a program on the `PATH`.
pub fn program(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// A C++ compiler and make build the messages' type supports.
pub fn require_compiler() -> Result<()> {
    let mut missing = Vec::new();
    if program("c++").or_else(|| program("g++")).is_none() {
        missing.push("g++");
    }
    if program("make").is_none() {
        missing.push("make");
    }
    install(&missing, "a C++ compiler and make build the message libraries")
}

/// Installs Debian packages when root, else names them.
pub fn install(packages: &[&str], why: &str) -> Result<()> {
    if packages.is_empty() {
        return Ok(());
    }
    let list = packages.join(" ");
    if !may_install() {
        bail!("missing system packages ({why}): apt-get install {list}");
    }
    let step = Step::begin(format!("system packages: {list}"));
    let log = workspace::cache()?.join("apt.log");
    let apt = |arguments: &[&str]| {
        let mut command = Command::new("apt-get");
        command.env("DEBIAN_FRONTEND", "noninteractive").args(arguments);
        command
    };
    let mut arguments = vec!["install", "-y", "--no-install-recommends"];
    arguments.extend(packages);
    // A fresh container has no package lists; an old one has stale ones.
    step.run(&mut apt(&["update"]), &log)?;
    step.run(&mut apt(&arguments), &log)?;
    step.done();
    Ok(())
}

/// Whether packages can be installed at all: root on a system with apt.
pub fn may_install() -> bool {
    rustix::process::geteuid().is_root() && program("apt-get").is_some()
}
