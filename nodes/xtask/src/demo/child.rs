//! Processes that we start, watch and stop, and that never outlive us.

use anyhow::{Context, Result, bail};
use rustix::process::{Pid, Signal};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child as Process, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// What the children tell.
#[derive(Debug)]
pub enum Event {
    /// A line on stdout or stderr.
    Line { child: usize, text: String, error: bool },
    /// An output was closed: no more lines come from it.
    Closed { child: usize },
}

/// One process: its name, and what it has said.
pub struct Child {
    /// What people call it.
    pub name: String,
    process: Process,
    status: Option<ExitStatus>,
    /// It said `ready: ...`.
    pub ready: bool,
    /// The lines of stdout, but for the ready one.
    pub said: Vec<String>,
    /// The lines of stderr.
    pub complaints: Vec<String>,
    open_outputs: u8,
}

/// All processes of one run. Dropped, it kills what still runs.
pub struct Family {
    /// In the order of their start.
    pub children: Vec<Child>,
    events: Receiver<Event>,
    sender: Sender<Event>,
}

impl Family {
    /// No children yet.
    pub fn new() -> Self {
        let (sender, events) = std::sync::mpsc::channel();
        Self { children: Vec::new(), events, sender }
    }

    /// Starts a process in a group of its own, so that Ctrl-C reaches us alone and we decide the order of the end.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn start(&mut self, name: &str, command: &Command) -> Result<usize> {
        // The command is started by way of ourselves, see `become_child`.
        // (`/proc/self/exe` reaches us even if a build has replaced our file meanwhile.)
        let mut own = Command::new("/proc/self/exe");
        own.arg("as-child").arg(std::process::id().to_string()).arg(command.get_program()).args(command.get_args());
        for (key, value) in command.get_envs() {
            match value {
                Some(value) => own.env(key, value),
                None => own.env_remove(key),
            };
        }
        if let Some(folder) = command.get_current_dir() {
            own.current_dir(folder);
        }
        own.process_group(0).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = own.spawn().with_context(|| format!("{name}: cannot be started"))?;
        let child = self.children.len();
        if let Some(output) = process.stdout.take() {
            self.listen(child, output, false);
        }
        if let Some(output) = process.stderr.take() {
            self.listen(child, output, true);
        }
        self.children.push(Child {
            name: name.to_owned(),
            process,
            status: None,
            ready: false,
            said: Vec::new(),
            complaints: Vec::new(),
            open_outputs: 2,
        });
        Ok(child)
    }

    fn listen(&self, child: usize, output: impl Read + Send + 'static, error: bool) {
        let sender = self.sender.clone();
        thread::spawn(move || {
            for line in BufReader::new(output).split(b'\n') {
                let Ok(line) = line else { break };
                let text = String::from_utf8_lossy(&line).trim_end().to_owned();
                if sender.send(Event::Line { child, text, error }).is_err() {
                    return;
                }
            }
            let _ = sender.send(Event::Closed { child });
        });
    }

    /// Takes in what the children say and do for at most `limit`; returns after the first news.
    pub fn listen_for(&mut self, limit: Duration) {
        match self.events.recv_timeout(limit) {
            Ok(event) => self.take(event),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
        }
        while let Ok(event) = self.events.try_recv() {
            self.take(event);
        }
        for child in &mut self.children {
            child.look();
        }
    }

    fn take(&mut self, event: Event) {
        match event {
            Event::Closed { child } => self.children[child].open_outputs -= 1,
            Event::Line { child, text, error } => {
                let child = &mut self.children[child];
                if error {
                    child.complaints.push(text);
                } else if text.starts_with("ready:") {
                    child.ready = true;
                } else {
                    child.said.push(text);
                }
            }
        }
    }

    /// The first child that has ended, with all it said.
    pub fn dead(&mut self) -> Option<usize> {
        let child = self.children.iter().position(|child| child.status.is_some())?;
        self.hear_out(child);
        Some(child)
    }

    /// The last words of one that has ended may still be on their way; grandchildren could keep the output open for ever.
    fn hear_out(&mut self, child: usize) {
        let patience = Instant::now() + Duration::from_secs(1);
        while self.children[child].open_outputs > 0 && Instant::now() < patience {
            self.listen_for(Duration::from_millis(20));
        }
    }

    /// Asks one child to end, politely first, and waits until it has and all it said was heard.
    pub fn stop(&mut self, child: usize, patience: Duration) -> ExitStatus {
        for (signal, patience) in
            [(Signal::INT, patience), (Signal::TERM, Duration::from_secs(2)), (Signal::KILL, Duration::from_secs(5))]
        {
            self.children[child].send(signal);
            let until = Instant::now() + patience;
            while Instant::now() < until {
                if let Some(status) = self.children[child].status {
                    self.hear_out(child);
                    return status;
                }
                self.listen_for(Duration::from_millis(20));
            }
        }
        // Even a kill did not end it: it hangs in the kernel, and so would waiting for it.
        self.children[child].status.unwrap_or_else(|| ExitStatus::from_raw(Signal::KILL.as_raw()))
    }
}

impl Drop for Family {
    fn drop(&mut self) {
        for child in &mut self.children {
            child.look();
            child.send(Signal::KILL);
        }
        for child in &mut self.children {
            if child.status.is_none() {
                let _ = child.process.wait();
            }
        }
    }
}

impl Child {
    /// How it ended, if it has.
    pub fn status(&self) -> Option<ExitStatus> {
        self.status
    }

    /// The process id.
    pub fn id(&self) -> u32 {
        self.process.id()
    }

    fn look(&mut self) {
        if self.status.is_none() {
            self.status = self.process.try_wait().ok().flatten();
        }
    }

    fn send(&mut self, signal: Signal) {
        if self.status.is_none()
            && let Some(pid) = i32::try_from(self.process.id()).ok().and_then(Pid::from_raw)
        {
            // A child that ended meanwhile cannot be signalled, and need not be.
            let _ = rustix::process::kill_process(pid, signal);
        }
    }

    /// The end in words: its own error line if it said one, else the status.
    pub fn last_words(&self) -> String {
        let said = self.complaints.iter().rev().find_map(|line| line.strip_prefix("error: "));
        match (said, self.status) {
            (Some(said), _) => said.to_owned(),
            (None, Some(status)) => match self.complaints.iter().rev().find(|line| !line.is_empty()) {
                Some(line) => format!("{status}; it said: {line}"),
                None => status.to_string(),
            },
            (None, None) => "still running".to_owned(),
        }
    }
}

/// The first thing that a child does, as this program still: it asks the system for SIGTERM should its parent die, so
/// that nothing is left behind even when the parent is killed, and then becomes the program it is to be. This keeps
/// clear of code between fork and exec, which could not be safe.
pub fn become_child(parent: u32, program: &[std::ffi::OsString]) -> Result<()> {
    rustix::process::set_parent_process_death_signal(Some(Signal::TERM))
        .context("cannot ask for a signal at the parent's death")?;
    let now = rustix::process::getppid().map(|pid| pid.as_raw_nonzero().get());
    if now != i32::try_from(parent).ok() {
        bail!("the parent {parent} has died");
    }
    let [program, arguments @ ..] = program else { bail!("no program named") };
    Err(Command::new(program).args(arguments).exec())
        .with_context(|| format!("{}: cannot be started", program.display()))
}
