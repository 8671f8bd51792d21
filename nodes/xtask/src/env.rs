//! `cargo xtask env`: a ROS 2 to build and run with, the messages on top of it, and the variables that say so.

mod fix_ups;
mod libclang;
mod overlay;
pub mod packaging;
mod pypi;
mod python;
mod sourced;
mod system;
mod variables;

use crate::workspace;
use anyhow::Result;
pub use pypi::bring_python_tools;
use std::process::ExitCode;
pub use system::{install as install_packages, may_install as may_install_packages, program};
pub use variables::Variables;

/// ROS 2 without our messages: where it lies and how it is reached.
struct Ros {
    /// Names this installation in the key of what is built on it.
    identity: String,
    variables: Variables,
}

/// Brings what is missing and returns the environment for building and running the nodes.
pub fn bring() -> Result<Variables> {
    let cache = workspace::cache()?;
    system::require_compiler()?;
    let ros = match sourced::find(&cache)? {
        Some(ros) => ros,
        None => pypi::bring(&cache)?,
    };
    let mut variables = overlay::bring(&cache, &ros)?;
    libclang::bring(&cache, &mut variables)?;
    if std::env::var_os("HOME").is_none() && std::env::var_os("ROS_LOG_DIR").is_none() {
        // rcl refuses to start when it finds neither.
        variables.set("ROS_LOG_DIR", cache.join("log").display());
    }
    Ok(variables)
}

/// Prints the environment as shell commands.
pub fn print() -> Result<ExitCode> {
    print!("{}", bring()?.to_shell());
    Ok(ExitCode::SUCCESS)
}
