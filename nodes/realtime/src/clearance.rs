use rustix::thread::{CpuSet, Pid, sched_getaffinity, sched_setaffinity};

/// Moves the process' other threads off `cpu`, which the calling thread has been pinned to; threads that they start
/// later inherit it.
///
/// The middleware's threads spend their time in system calls, and on a kernel without full preemption a real-time thread
/// waits until such a call has ended. Threads that may run nowhere else (pinned there themselves, or a machine of one
/// processor) stay. Other processes are the user's to place: `taskset`, `isolcpus=`.
pub(crate) fn clear(cpu: usize) {
    let own = rustix::thread::gettid();
    for thread in threads().filter(|t| *t != own) {
        // A thread may end in between: nothing is left to move then.
        let Ok(mut allowed) = sched_getaffinity(Some(thread)) else { continue };
        if !allowed.is_set(cpu) {
            continue;
        }
        allowed.unset(cpu);
        if allowed != CpuSet::new() {
            let _ = sched_setaffinity(Some(thread), &allowed);
        }
    }
}

/// The threads of this process.
fn threads() -> impl Iterator<Item = Pid> {
    let entries = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok().and_then(Pid::from_raw))
}
