use crate::clearance::clear;
use crate::idle::stay_awake;
use rustix::mm::{MlockAllFlags, mlockall};
use rustix::thread::{CpuSet, sched_setaffinity};
use serde::{Deserialize, Serialize};
use std::fmt;
use thread_priority::unix::{ScheduleParams, set_thread_priority_and_policy, thread_native_id};
use thread_priority::{RealtimeThreadSchedulePolicy, ThreadPriority, ThreadSchedulePolicy};

/// What a real-time thread asks of the system. Each is granted or refused on its own; a refusal never stops the thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ThreadSetup {
    /// `SCHED_FIFO` priority, 1 to 99; 0 asks for none.
    pub priority: u8,
    /// The processor to stay on, from 0, and the process' other threads off it; -1 leaves it to the scheduler.
    pub cpu: i32,
    /// Whether the process' memory shall be locked.
    pub lock_memory: bool,
}

impl Default for ThreadSetup {
    fn default() -> Self {
        Self { priority: 80, cpu: -1, lock_memory: true }
    }
}

/// The answer to one request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Grant {
    /// Given.
    Granted,
    /// Not asked for.
    NotAsked,
    /// Refused: why, and what would grant it.
    Refused {
        /// The system's reason.
        reason: String,
        /// What to do about it.
        remedy: &'static str,
    },
}

/// The answers to a [`ThreadSetup`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GrantReport {
    /// `SCHED_FIFO`.
    pub scheduling: Grant,
    /// Processor affinity.
    pub affinity: Grant,
    /// Locked memory.
    pub memory: Grant,
    /// Processors kept out of slow idle states; asked for with `SCHED_FIFO`.
    pub idle: Grant,
}

impl GrantReport {
    /// True if nothing that was asked for was refused.
    #[must_use]
    pub fn all_granted(&self) -> bool {
        [&self.scheduling, &self.affinity, &self.memory, &self.idle].iter().all(|g| !matches!(g, Grant::Refused { .. }))
    }
}

const HOW_PRIORITY: &str =
    "add `@realtime - rtprio 95` to /etc/security/limits.d/realtime.conf and the user to that group, or CAP_SYS_NICE";
const HOW_MEMORY: &str = "add `@realtime - memlock unlimited` to /etc/security/limits.d/realtime.conf and the user to that group, or CAP_IPC_LOCK";
const HOW_CPU: &str = "name a processor that exists and that the process' cpuset allows (`nproc`, `taskset -p`)";

impl ThreadSetup {
    /// Stack that is touched in advance, bytes: the tick's own need and a wide margin.
    const STACK: usize = 256 * 1024;

    /// Applies it to the calling thread (memory: to the whole process) and touches the stack. Allocates and makes system
    /// calls: before the loop, never in it.
    #[must_use]
    pub fn apply(&self) -> GrantReport {
        let memory = if self.lock_memory { lock_memory() } else { Grant::NotAsked };
        touch_stack();
        let affinity = if self.cpu < 0 { Grant::NotAsked } else { pin(self.cpu as usize) };
        let scheduling = if self.priority == 0 { Grant::NotAsked } else { fifo(self.priority) };
        let idle = if self.priority == 0 { Grant::NotAsked } else { stay_awake() };
        GrantReport { scheduling, affinity, memory, idle }
    }
}

fn refused(reason: impl fmt::Display, remedy: &'static str) -> Grant {
    Grant::Refused { reason: reason.to_string(), remedy }
}

fn fifo(priority: u8) -> Grant {
    let priority = ThreadPriority::from_posix(ScheduleParams { sched_priority: i32::from(priority) });
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    match set_thread_priority_and_policy(thread_native_id(), priority, policy) {
        Ok(()) => Grant::Granted,
        Err(thread_priority::Error::OS(code)) => refused(std::io::Error::from_raw_os_error(code), HOW_PRIORITY),
        Err(_) => refused("the priority must be between 1 and 99", "set a priority between 1 and 99"),
    }
}

fn pin(cpu: usize) -> Grant {
    if cpu >= CpuSet::MAX_CPU {
        return refused(format_args!("no processor {cpu}"), HOW_CPU);
    }
    let mut set = CpuSet::new();
    set.set(cpu);
    match sched_setaffinity(None, &set) {
        Ok(()) => {
            clear(cpu);
            Grant::Granted
        }
        Err(e) => refused(e, HOW_CPU),
    }
}

/// Locks pages as they are touched, instead of all that is mapped: a process with a middleware in it maps the stacks
/// and arenas of dozens of threads. The loop's own pages are touched before it starts.
fn lock_memory() -> Grant {
    let limit = rustix::process::getrlimit(rustix::process::Resource::Memlock);
    if limit.current.is_some() && !rustix::process::geteuid().is_root() {
        // Locking under a limit would make later allocations anywhere in the process fail.
        return refused("locked memory is limited (RLIMIT_MEMLOCK)", HOW_MEMORY);
    }
    match mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE | MlockAllFlags::ONFAULT) {
        Ok(()) => Grant::Granted,
        Err(e) => refused(e, HOW_MEMORY),
    }
}

/// Touches every page of the stack that the loop may come to use, so that none is faulted in later.
#[inline(never)]
fn touch_stack() {
    let mut stack = [0u8; ThreadSetup::STACK];
    for page in stack.chunks_mut(4096) {
        page[0] = 1;
    }
    std::hint::black_box(&mut stack);
}

impl fmt::Display for Grant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Granted => f.write_str("granted"),
            Self::NotAsked => f.write_str("not asked for"),
            Self::Refused { reason, remedy } => write!(f, "refused: {reason}; to grant it: {remedy}"),
        }
    }
}

impl fmt::Display for GrantReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scheduling, affinity, memory, idle } = self;
        write!(f, "SCHED_FIFO {scheduling}; affinity {affinity}; locked memory {memory}; no slow idle states {idle}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_own_thread(setup: ThreadSetup) -> GrantReport {
        std::thread::spawn(move || setup.apply()).join().unwrap()
    }

    #[test]
    fn nothing_asked_nothing_refused() {
        let report = on_own_thread(ThreadSetup { priority: 0, cpu: -1, lock_memory: false });
        assert_eq!(report.scheduling, Grant::NotAsked);
        assert!(report.all_granted());
    }

    #[test]
    fn impossible_requests_are_refused_with_reason_and_remedy() {
        for cpu in [1023, 1_000_000] {
            let report = on_own_thread(ThreadSetup { priority: 120, cpu, lock_memory: false });
            assert!(!report.all_granted());
            let text = report.to_string();
            assert!(text.contains("between 1 and 99") && text.contains("nproc"), "{text}");
        }
    }

    #[test]
    fn an_existing_processor_is_granted() {
        let allowed = rustix::thread::sched_getaffinity(None).unwrap();
        let cpu = (0..CpuSet::MAX_CPU).find(|c| allowed.is_set(*c)).unwrap();
        let report = on_own_thread(ThreadSetup { priority: 0, cpu: cpu as i32, lock_memory: false });
        assert_eq!(report.affinity, Grant::Granted);
    }
}
