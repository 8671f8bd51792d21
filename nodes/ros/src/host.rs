use crate::failure::panic_text;
use crate::{Failure, Outcome, qos};
use r2r::rcl_interfaces::msg::Log;
use r2r::{Clock, Context, Node, Publisher};
use spatial::Stamp;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// One node in one process: its name, its clock and the signals that end it.
///
/// The thread that owns it calls [`Host::spin_once`] and nothing else blocks; whoever leaves `main` does so after the
/// host was dropped, for a middleware that is still spinning does not survive the end of the process.
pub struct Host {
    /// The node itself.
    pub node: Node,
    name: String,
    clock: Arc<Mutex<Clock>>,
    stop: Arc<AtomicBool>,
    /// Where `rqt_console` looks; none where the ROS at hand has no such topic.
    rosout: Option<Publisher<Log>>,
}

impl Host {
    /// Starts the middleware with the process's `--ros-args` and makes a node; `name` is what it is called unless
    /// remapped. `--help` is answered with `what` it does and its `parameters` as a file to start from; other arguments outside
    /// `--ros-args ... [--]` are refused.
    ///
    /// # Errors
    /// Usage, malformed `--ros-args`, an unreadable parameter file, an impossible name or domain.
    pub fn start(name: &str, what: &str, parameters: fn() -> String) -> Outcome<Self> {
        let mut host = Self::open(name, what, parameters)?;
        if host.wants_sim_time() {
            let source = host.node.get_time_source();
            source.enable_sim_time(&mut host.node)?;
        }
        Ok(host)
    }

    /// The same for a node with a hand at it. A hand lives in real time: `/clock` is not followed, lest stamps mix or a
    /// paused simulation hold a force; `use_sim_time` gives a warning.
    ///
    /// # Errors
    /// As [`Host::start`].
    pub fn start_in_real_time(name: &str, what: &str, parameters: fn() -> String) -> Outcome<Self> {
        let host = Self::open(name, what, parameters)?;
        if host.wants_sim_time() {
            host.warn("use_sim_time is not followed: a hand lives in real time, all stamps are of the system's clock");
        }
        Ok(host)
    }

    fn open(name: &str, what: &str, parameters: fn() -> String) -> Outcome<Self> {
        check_arguments(name, what, parameters, std::env::args().skip(1))?;
        let stop = Arc::new(AtomicBool::new(false));
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
            signal_hook::flag::register(signal, Arc::clone(&stop))
                .map_err(|e| Failure::new(format!("signal {signal} cannot be caught: {e}")))?;
        }
        check_domain(std::env::var("ROS_DOMAIN_ID").ok().as_deref())?;
        // The middleware's own start panics on arguments it cannot read.
        let context = quietly(|| std::panic::catch_unwind(Context::create))
            .map_err(|p| {
                Failure::usage(format!("ROS: {}; see the README for examples", without_origin(&panic_text(p.as_ref()))))
            })?
            .map_err(|e| Failure::new(format!("ROS does not start: {e}; is the environment sourced and HOME set?")))?;
        let mut node = Node::create(context, name, "").map_err(|e| {
            Failure::new(format!(
                "node `{name}` cannot be made: {e}; check its name and namespace, ROS_DOMAIN_ID and RMW_IMPLEMENTATION"
            ))
        })?;
        let name = node.fully_qualified_name()?;
        let clock = node.get_ros_clock();
        let rosout = node.create_publisher("/rosout", qos::latched(1000)).ok();
        Ok(Self { node, name, clock, stop, rosout })
    }

    fn wants_sim_time(&self) -> bool {
        matches!(self.node.get_parameter::<bool>("use_sim_time"), Ok(true))
    }

    /// The node's name with its namespace, after remapping.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Robot time: the system's clock, or `/clock` if `use_sim_time` is set and followed.
    #[must_use]
    pub fn now(&self) -> Stamp {
        let now = self.clock.lock().ok().and_then(|mut c| c.get_now().ok()).unwrap_or_default();
        Stamp(i64::try_from(now.as_nanos()).unwrap_or(i64::MAX))
    }

    /// Handles what has come, or waits up to `timeout` for it: at most one message of each subscription.
    pub fn spin_once(&mut self, timeout: Duration) {
        self.node.spin_once(timeout);
    }

    /// Lives on for `time`, whatever comes meanwhile: what was just sent is on its way, and goes when its publisher goes.
    pub fn linger(&mut self, time: Duration) {
        let end = Instant::now() + time;
        while let Some(rest) = end.checked_duration_since(Instant::now()).filter(|r| !r.is_zero()) {
            self.spin_once(rest);
        }
    }

    /// Whether a signal asked the process to end.
    #[must_use]
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The flag that the signals set, for other threads of the process.
    #[must_use]
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// Says on stdout that the node is up: launchers wait for this line.
    pub fn say_ready(&self) {
        println!("ready: {}", self.name);
        let _ = std::io::stdout().flush();
        self.log(Log::INFO as u8, "ready");
    }

    /// Says one line of progress on stdout, and on `/rosout`.
    pub fn say(&self, line: &str) {
        println!("{}: {line}", self.name);
        let _ = std::io::stdout().flush();
        self.log(Log::INFO as u8, line);
    }

    /// Says one line of warning on stderr, and on `/rosout`.
    pub fn warn(&self, line: &str) {
        eprintln!("warning: {}: {line}", self.name);
        self.log(Log::WARN as u8, line);
    }

    fn log(&self, level: u8, line: &str) {
        let Some(rosout) = &self.rosout else { return };
        // Loggers have dots where nodes have slashes. Nothing depends on whether the line is heard.
        let name = self.name.trim_start_matches('/').replace('/', ".");
        let _ = rosout.publish(&Log {
            stamp: crate::convert::time(self.now()),
            level,
            name,
            msg: line.to_owned(),
            ..Log::default()
        });
    }
}

/// Refuses whatever stands outside `--ros-args ... [--]`.
fn check_arguments(
    name: &str,
    what: &str,
    parameters: fn() -> String,
    args: impl Iterator<Item = String>,
) -> Outcome<()> {
    let mut inside = false;
    for arg in args {
        match (inside, arg.as_str()) {
            (false, "--ros-args") => inside = true,
            (true, "--") => inside = false,
            (true, _) => {}
            (false, "-h" | "--help") => {
                let text = format!(
                    "{name}: {what}\n\n\
                    usage: {name} [--ros-args [-p NAME:=VALUE]... [--params-file FILE]... [-r FROM:=TO]...]\n\n\
                    {}",
                    parameters()
                );
                // A reader that has gone away (`| head`) has seen what it wanted.
                let _ = std::io::stdout().write_all(text.as_bytes());
                std::process::exit(0);
            }
            (false, "-V" | "--version") => {
                println!("{name} {}", env!("CARGO_PKG_VERSION"));
                std::process::exit(0);
            }
            (false, other) => {
                return Err(Failure::usage(format!(
                    "unknown argument `{other}`; usage: {name} [--ros-args -p NAME:=VALUE --params-file FILE -r FROM:=TO]"
                )));
            }
        }
    }
    Ok(())
}

/// Runs `start` with stderr closed: what the middleware says there in several lines stands in its error too, and comes
/// out as the one line that launchers and people look for.
fn quietly<T>(start: impl FnOnce() -> T) -> T {
    let saved = rustix::io::dup(std::io::stderr()).ok();
    let nowhere = std::fs::OpenOptions::new().write(true).open("/dev/null");
    if let (Some(_), Ok(nowhere)) = (&saved, nowhere) {
        let _ = rustix::stdio::dup2_stderr(nowhere);
    }
    let outcome = start();
    if let Some(saved) = saved {
        let _ = rustix::stdio::dup2_stderr(saved);
    }
    outcome
}

/// Domains beyond 232 have no ports.
fn check_domain(id: Option<&str>) -> Outcome<()> {
    match id.map(str::trim).filter(|s| !s.is_empty()).map(str::parse::<u32>) {
        None | Some(Ok(0..=232)) => Ok(()),
        Some(_) => {
            Err(Failure::new(format!("ROS_DOMAIN_ID = `{}` is not a number from 0 to 232", id.unwrap_or_default())))
        }
    }
}

/// The middleware's text without the place in its own sources.
fn without_origin(text: &str) -> String {
    text.split(", at ").next().unwrap_or(text).trim_end_matches(['.', ' ']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(args: &[&str]) -> Outcome<()> {
        check_arguments("node", "", String::new, args.iter().map(|s| (*s).to_owned()))
    }

    #[test]
    fn only_ros_arguments_are_taken() {
        assert!(check(&[]).is_ok());
        assert!(check(&["--ros-args", "-p", "a:=1", "--"]).is_ok());
        assert_eq!(check(&["scene.yaml"]).unwrap_err().code(), 2);
        assert_eq!(check(&["--ros-args", "-p", "a:=1", "--", "--verbose"]).unwrap_err().code(), 2);
    }

    #[test]
    fn a_domain_has_ports() {
        assert!(check_domain(None).is_ok() && check_domain(Some("0")).is_ok() && check_domain(Some("232")).is_ok());
        for bad in ["233", "-1", "abc", "1.5"] {
            assert!(check_domain(Some(bad)).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_place_in_foreign_sources_is_left_out() {
        assert_eq!(without_origin("Couldn't parse 'x', at ./src/rcl/arguments.c:343"), "Couldn't parse 'x'");
    }
}
