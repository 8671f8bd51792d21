//! What the demo came to, as text.

use super::processes::Report;
use super::{Arguments, Output};
use crate::cargo_build::Executables;
use crate::env::Variables;
use anyhow::{Context, Result, bail};
use std::fs;
use std::process::ExitCode;

/// Writes `summary.txt` and prints it.
///
/// # Errors
/// The bag does not open, or the recording is missing.
pub fn write(
    executables: &Executables,
    variables: &Variables,
    output: &Output,
    arguments: &Arguments,
    report: &Report,
) -> Result<ExitCode> {
    let said = variables
        .command(executables.get("cspace-haptics")?)
        .args(["bag", "summary"])
        .arg(output.bag())
        .output()
        .context("cspace-haptics: cannot be started")?;
    if !said.status.success() {
        bail!("{}", String::from_utf8_lossy(&said.stderr).trim().trim_start_matches("error: "));
    }
    let size =
        fs::metadata(output.recording()).with_context(|| format!("{}: missing", output.recording().display()))?.len();
    let mut text = format!(
        "scene           {}\ndevice          {}\nduration        {} s",
        arguments.scene, arguments.device, arguments.duration
    );
    if report.interrupted {
        text.push_str(" (ended early)");
    }
    if let Some(ticks) = ticks_run(&report.lines) {
        text.push_str(&format!("\nticks run       {ticks}"));
    }
    text.push_str(&format!("\nrecording       demo.rrd, {:.1} MB\n", size as f64 / 1e6));
    // What each process ended with; what it began with is of no interest any more.
    for line in report.lines.iter().filter(|line| !line.contains(": recording ")) {
        text.push_str(line);
        text.push('\n');
    }
    text.push('\n');
    text.push_str(&String::from_utf8_lossy(&said.stdout));
    fs::write(output.summary(), &text).with_context(|| format!("{}: cannot write", output.summary().display()))?;
    print!("{text}");
    println!("\nleft in {}", output.folder().display());
    Ok(ExitCode::SUCCESS)
}

/// The count in the line that the servo ends with.
fn ticks_run(lines: &[String]) -> Option<u64> {
    let words = lines.iter().filter(|line| line.starts_with("haptic_servo: ")).flat_map(|line| line.split_whitespace());
    words.filter_map(|word| word.strip_prefix("ticks=")?.parse().ok()).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_servo_counts_not_the_recorder() {
        let line = |text: &str| text.to_owned();
        let lines = [
            line("haptic_recorder: /r: recorded bag: ticks=7 lost=0"),
            line("haptic_servo: /s: ticks=9 late=1"),
            line("x"),
        ];
        assert_eq!(ticks_run(&lines), Some(9));
        assert_eq!(ticks_run(&lines[..1]), None);
    }
}
