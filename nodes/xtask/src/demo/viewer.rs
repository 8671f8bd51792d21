//! The rerun viewer beside the demo.

use super::child::Family;
use crate::env;
use anyhow::{Context, Result, bail};
use std::net::{Ipv4Addr, SocketAddrV4, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long the window may take to open.
const READY: Duration = Duration::from_secs(60);

/// An open viewer; closed when dropped.
pub struct Viewer {
    family: Family,
    /// Where it listens.
    pub address: SocketAddrV4,
}

impl Viewer {
    /// Brings the viewer from PyPI if need be, and opens it on a free port of this machine.
    ///
    /// # Errors
    /// It cannot be brought, or no window opens.
    pub fn open() -> Result<Self> {
        let program = program(&env::bring_python_tools()?)?;
        // The port was free a moment ago; should somebody take it in between, the viewer says so and ends.
        let port = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).context("no free port")?.local_addr()?.port();
        let address = SocketAddrV4::new(Ipv4Addr::LOCALHOST, port);
        let mut family = Family::new();
        let mut command = Command::new(program);
        command.args(["--bind", "127.0.0.1", "--port", &port.to_string(), "--expect-data-soon"]);
        family.start("rerun", &command)?;
        let begun = Instant::now();
        while TcpStream::connect_timeout(&address.into(), Duration::from_millis(200)).is_err() {
            family.listen_for(Duration::from_millis(100));
            if let Some(dead) = family.dead() {
                bail!("the rerun viewer does not open: {}", family.children[dead].last_words());
            }
            if begun.elapsed() > READY {
                bail!("the rerun viewer does not listen on {address} after {} s", READY.as_secs());
            }
        }
        Ok(Self { family, address })
    }

    /// Waits until the window is closed, or somebody asks for the end.
    pub fn wait(mut self, stop: &AtomicBool) {
        eprintln!("... close the viewer, or press Ctrl-C, to end");
        while self.family.dead().is_none() && !stop.load(Ordering::Relaxed) {
            self.family.listen_for(Duration::from_millis(200));
        }
    }
}

/// The viewer itself; `bin/rerun` is a Python program that starts it.
///
/// # Errors
/// The tools do not hold it.
pub fn program(tools: &Path) -> Result<PathBuf> {
    std::fs::read_dir(tools.join("lib"))
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path().join("site-packages/rerun_sdk/rerun_cli/rerun"))
        .find(|path| path.is_file())
        .with_context(|| format!("{}: holds no rerun viewer", tools.display()))
}
