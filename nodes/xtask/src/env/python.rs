//! A CPython of the system that can make virtual environments and build extension modules.

use super::system;
use anyhow::{Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// An interpreter that the wheels exist for.
#[derive(Debug, Clone)]
pub struct Python {
    /// The interpreter itself, shims resolved.
    pub executable: PathBuf,
    /// Major and minor, such as `3.11`.
    pub version: String,
    /// The folder of `Python.h`.
    pub include: PathBuf,
}

impl Python {
    /// The folder of pure and binary modules of a virtual environment at `prefix`.
    pub fn site_packages(&self, prefix: &Path) -> PathBuf {
        prefix.join(format!("lib/python{}/site-packages", self.version))
    }
}

const NAMES: [&str; 5] = ["python3", "python3.13", "python3.12", "python3.11", "python3.10"];
const PROBE: &str = "
import os, sys, sysconfig, importlib.util as u
v = sys.version_info
include = sysconfig.get_path('include')
# Inside a virtual environment (one of ours may be first on the PATH) the interpreter that it was made from.
executable = os.path.realpath(getattr(sys, '_base_executable', None) or sys.executable)
print(sys.implementation.name, v[0], v[1], executable, include, sep='|')
print(int(u.find_spec('ensurepip') is not None), int(os.path.isfile(os.path.join(include, 'Python.h'))), sep='|')
";

enum Probe {
    Fit(Python),
    /// Fit but for these Debian packages.
    Lacks(Vec<&'static str>),
    Unfit(String),
}

/// Finds an interpreter, CPython 3.10 to 3.13; installs Debian's missing parts when root.
pub fn find() -> Result<Python> {
    let mut reasons = Vec::new();
    let mut lacking: Option<Vec<&'static str>> = None;
    for name in NAMES {
        match probe(name) {
            Probe::Fit(python) => return Ok(python),
            Probe::Lacks(packages) => {
                reasons.push(format!("{name} lacks {}", packages.join(" ")));
                lacking.get_or_insert(packages);
            }
            Probe::Unfit(reason) if reason.is_empty() => {}
            Probe::Unfit(reason) => reasons.push(format!("{name} {reason}")),
        }
    }
    let packages = lacking.unwrap_or_else(|| vec!["python3", "python3-venv", "python3-dev"]);
    if !system::may_install() {
        let found = if reasons.is_empty() { "none found".to_owned() } else { reasons.join(", ") };
        bail!(
            "ROS 2 from PyPI needs a CPython 3.10 to 3.13 with venv and headers ({found}): apt-get install {}",
            packages.join(" ")
        );
    }
    system::install(&packages, "ROS 2 from PyPI needs a CPython 3.10 to 3.13 with venv and headers")?;
    for name in NAMES.map(str::to_owned).into_iter().chain(["/usr/bin/python3".to_owned()]) {
        if let Probe::Fit(python) = probe(&name) {
            return Ok(python);
        }
    }
    bail!("no CPython 3.10 to 3.13 with venv and headers, even after installing {}", packages.join(" "))
}

fn probe(name: &str) -> Probe {
    // A pyenv shim of a version that is not active exists and fails: that is not worth a word.
    let output = match Command::new(name).args(["-I", "-c", PROBE]).output() {
        Ok(output) if output.status.success() => output,
        _ => return Probe::Unfit(String::new()),
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let fields: Vec<&str> = text.split(['|', '\n']).collect();
    let [implementation, major, minor, executable, include, ensurepip, headers, ..] = fields[..] else {
        return Probe::Unfit("does not answer as a Python does".to_owned());
    };
    let version = format!("{major}.{minor}");
    if implementation != "cpython" || major != "3" || !matches!(minor, "10" | "11" | "12" | "13") {
        return Probe::Unfit(format!("is {implementation} {version}"));
    }
    let mut lacks = Vec::new();
    if ensurepip != "1" {
        lacks.push("python3-venv");
    }
    if headers != "1" {
        lacks.push("python3-dev");
    }
    if !lacks.is_empty() {
        return Probe::Lacks(lacks);
    }
    Probe::Fit(Python { executable: executable.into(), version, include: include.into() })
}
