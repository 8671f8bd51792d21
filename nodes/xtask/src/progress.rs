//! Progress on stderr: a spinner with the step's newest line on a terminal, plain lines elsewhere.

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufRead, BufReader, IsTerminal, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// One thing that takes time. Dropped without [`Step::done`], it says nothing more: the error does.
pub struct Step {
    name: String,
    bar: Option<ProgressBar>,
    begun: Instant,
}

impl Step {
    /// Begins a step and shows its name.
    pub fn begin(name: impl Into<String>) -> Self {
        let name = name.into();
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            bar.set_style(
                ProgressStyle::with_template("{spinner} {prefix} [{elapsed}] {wide_msg}").expect("a valid template"),
            );
            bar.set_prefix(name.clone());
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        if bar.is_none() {
            eprintln!("... {name}");
        }
        Self { name, bar, begun: Instant::now() }
    }

    /// Shows a passing detail, on a terminal only.
    pub fn detail(&self, text: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(text.trim().to_owned());
        }
    }

    /// Prints a line that stays.
    pub fn note(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.println(text),
            None => eprintln!("    {text}"),
        }
    }

    /// Ends the step well.
    pub fn done(self) {
        let seconds = self.begun.elapsed().as_secs_f64();
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        eprintln!("ok  {} ({seconds:.1} s)", self.name);
    }

    /// Runs `command` to its end with its output in the file `log`, its newest line as the detail.
    ///
    /// # Errors
    /// When it cannot be started or fails; the last lines of its output are printed, the error is one line.
    pub fn run(&self, command: &mut Command, log: &Path) -> Result<()> {
        self.run_reading(command, log, |_| false)
    }

    /// The same; `read` sees each line first and keeps it from people by returning true.
    ///
    /// # Errors
    /// As for [`Step::run`].
    pub fn run_reading(&self, command: &mut Command, log: &Path, mut read: impl FnMut(&str) -> bool) -> Result<()> {
        let program = command.get_program().to_string_lossy().into_owned();
        let (reader, writer) = std::io::pipe().context("cannot create a pipe")?;
        command.stdin(Stdio::null()).stdout(writer.try_clone()?).stderr(writer);
        let mut child = command.spawn().with_context(|| format!("{program}: cannot be started"))?;
        // The command keeps the pipe's writing ends; the reader below ends only when all are closed.
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut file = File::options()
            .create(true)
            .append(true)
            .open(log)
            .with_context(|| format!("{}: cannot write", log.display()))?;
        let mut tail = VecDeque::new();
        let mut reader = BufReader::new(reader);
        let mut line = Vec::new();
        while reader.read_until(b'\n', &mut line)? > 0 {
            file.write_all(&line)?;
            let text = String::from_utf8_lossy(&line).trim_end().to_owned();
            line.clear();
            if read(&text) {
                continue;
            }
            self.detail(&text);
            if tail.len() == 8 {
                tail.pop_front();
            }
            tail.push_back(text);
        }
        let status = child.wait()?;
        if !status.success() {
            for line in tail {
                self.note(&line);
            }
            bail!("{}: {program} failed ({status}); all it said is in {}", self.name, log.display());
        }
        Ok(())
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
