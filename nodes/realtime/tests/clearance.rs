//! A program of its own: pinning moves every other thread of the process, other tests' too.

use realtime::{Grant, ThreadSetup};
use rustix::thread::{CpuSet, sched_getaffinity};
use std::sync::mpsc::channel;

fn processors() -> Vec<usize> {
    let allowed = sched_getaffinity(None).unwrap();
    (0..CpuSet::MAX_CPU).filter(|c| allowed.is_set(*c)).collect()
}

#[test]
fn a_pinned_thread_gets_its_processor_to_itself() {
    let all = processors();
    let &[cpu, elsewhere, ..] = all.as_slice() else { return eprintln!("SKIPPED: one processor") };
    let (say, hear) = channel();
    let (finish, wait) = channel::<()>();
    let middleware = std::thread::spawn(move || {
        say.send(rustix::thread::gettid()).unwrap();
        wait.recv().unwrap();
        // A thread that it starts now.
        std::thread::spawn(processors).join().unwrap()
    });
    let other = hear.recv().unwrap();
    assert!(sched_getaffinity(Some(other)).unwrap().is_set(cpu));
    let own = std::thread::spawn(move || {
        let setup = ThreadSetup { priority: 0, cpu: cpu as i32, lock_memory: false };
        let report = setup.apply();
        // Twice is as good as once: the first is pinned by then, and stays.
        let _ = std::thread::spawn(move || setup.apply()).join().unwrap();
        (report.affinity, processors())
    });
    assert_eq!(own.join().unwrap(), (Grant::Granted, vec![cpu]));
    let allowed = sched_getaffinity(Some(other)).unwrap();
    assert!(!allowed.is_set(cpu) && allowed.is_set(elsewhere));
    finish.send(()).unwrap();
    assert!(!middleware.join().unwrap().contains(&cpu));
}
