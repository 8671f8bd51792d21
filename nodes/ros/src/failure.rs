//! How a node ends that cannot go on.

use std::process::ExitCode;

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

/// Runs a node's body and turns its outcome into an exit code: 0, or one line `error: ...` on stderr and 1 or 2.
///
/// A panic anywhere is a defect of ours; it is still told in one line, after the force was let go by the drops on the way.
#[must_use]
pub fn run(body: impl FnOnce() -> Outcome<()>) -> ExitCode {
    std::panic::set_hook(Box::new(|_| {}));
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(body)).unwrap_or_else(|payload| {
        Err(Failure::new(format!("internal defect: {}; please report it", panic_text(payload.as_ref()))))
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(failure.code)
        }
    }
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
}
