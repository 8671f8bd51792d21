//! How a node ends: its outcome in a line and an exit code, whatever the middleware does.

use crate::Host;
use std::process::ExitCode;
use std::time::Duration;

/// What the middleware is given to end; launchers kill what has not ended five seconds after their signal.
///
/// Fast DDS can take for ever: a participant that goes spins on the lock that its own thread wants, which hears just then
/// of another that goes (`DomainParticipant::set_listener` against `onParticipantDiscovery`).
const LEAVE: Duration = Duration::from_secs(4);

/// Why a node cannot go on: one line that says what, where and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    line: String,
    code: u8,
}

/// What the nodes' functions return.
pub type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// Something in the world is wrong: exit code 1.
    #[must_use]
    pub fn new(line: impl Into<String>) -> Self {
        Self { line: one_line(&line.into()), code: 1 }
    }

    /// The command line is wrong: exit code 2.
    #[must_use]
    pub fn usage(line: impl Into<String>) -> Self {
        Self { line: one_line(&line.into()), code: 2 }
    }

    /// The code of a process that ends for this reason.
    #[must_use]
    pub const fn code(&self) -> u8 {
        self.code
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.line)
    }
}

impl std::error::Error for Failure {}

impl From<r2r::Error> for Failure {
    fn from(e: r2r::Error) -> Self {
        Self::new(format!("ROS: {e}"))
    }
}

impl From<anyhow::Error> for Failure {
    fn from(e: anyhow::Error) -> Self {
        Self::new(format!("{e:#}"))
    }
}

/// Runs a node: `start` makes its host, `body` lives on it. The outcome becomes an exit code: 0, or one line `error: ...`
/// on stderr and 1 or 2.
///
/// A panic anywhere is a defect of ours; it is still told in one line, after the force was let go by the drops on the way.
/// The middleware ends last, when all is said, and cannot hold up the process.
#[must_use]
pub fn run(start: impl FnOnce() -> Outcome<Host>, body: impl FnOnce(&mut Host) -> Outcome<()>) -> ExitCode {
    std::panic::set_hook(Box::new(|_| {}));
    let mut host = None;
    let life = std::panic::AssertUnwindSafe(|| body(host.insert(start()?)));
    let outcome = std::panic::catch_unwind(life).unwrap_or_else(|payload| {
        Err(Failure::new(format!("internal defect: {}; please report it", panic_text(payload.as_ref()))))
    });
    let code = outcome.map_or_else(
        |failure| {
            eprintln!("error: {failure}");
            failure.code
        },
        |()| 0,
    );
    end_within(LEAVE, code);
    drop(host);
    ExitCode::from(code)
}

/// Sees to it that the process ends with `code`, `time` from now at the latest.
fn end_within(time: Duration, code: u8) {
    let leave = move || {
        std::thread::sleep(time);
        eprintln!("warning: the middleware does not end; the process leaves it behind after {} s", time.as_secs());
        // At once: what runs at an orderly exit would wait for the middleware too.
        signal_hook::low_level::exit(code.into());
    };
    // Without a thread the middleware has all the time it wants.
    let _ = std::thread::Builder::new().spawn(leave);
}

/// What a panic said.
pub(crate) fn panic_text(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str).or_else(|| payload.downcast_ref::<&str>().copied());
    one_line(text.unwrap_or("panic without a text"))
}

fn one_line(text: &str) -> String {
    text.split(['\n', '\r']).map(str::trim).filter(|s| !s.is_empty()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_one_line_whatever_it_was_made_of() {
        assert_eq!(Failure::new("a\n  b\r\n\nc").to_string(), "a b c");
    }

    #[test]
    fn usage_and_failure_differ_in_their_exit_codes() {
        assert_eq!((Failure::new("x").code(), Failure::usage("x").code()), (1, 2));
    }
    /// Not a test by itself: a process whose middleware never ends.
    #[test]
    #[ignore = "started by the test below"]
    fn process_that_hangs() {
        if std::env::var_os(HANGS).is_some() {
            end_within(Duration::from_millis(200), 7);
            loop {
                std::thread::park();
            }
        }
    }

    const HANGS: &str = "FAILURE_TEST_HANGS";

    #[test]
    fn a_middleware_that_does_not_end_is_left_behind() {
        let ended = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "failure::tests::process_that_hangs", "--ignored", "--nocapture"])
            .env(HANGS, "1")
            .output()
            .unwrap();
        assert_eq!(ended.status.code(), Some(7), "{ended:?}");
        assert!(String::from_utf8_lossy(&ended.stderr).contains("does not end"), "{ended:?}");
    }
}
