use crate::failure::Failure;
use std::io::{ErrorKind, Write};

/// Prints one line. A reader that has gone away (`| head`) ends the program quietly: it has seen what it wanted.
pub fn say(line: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout().lock(), "{line}") {
        Ok(()) => Ok(()),
        Err(e) if e.kind() == ErrorKind::BrokenPipe => std::process::exit(0),
        Err(e) => Err(Failure::file("standard output", e)),
    }
}

/// Prints the one line of an error. Nobody is left to tell when this fails too.
pub fn complain(failure: &Failure) {
    let _ = writeln!(std::io::stderr().lock(), "error: {failure}");
}
