//! Between its first and its last sleep the servo thread makes no system call but that sleep: strace says so.

use device::{OperatorConfig, SimulatedOperator};
use servo::{Commands, Config, LoopConfig, Tick, operator_plan, spawn};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const TICKS: u64 = 1000;

/// What is traced: a thousand ticks of the loop with the simulated operator, however long they take.
#[test]
#[ignore = "run by `the_servo_thread_only_sleeps`, under strace"]
fn quiet_loop() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    let scene = scene::Scene::load(&path).unwrap();
    let mut tick = Tick::new(&scene, &Config::default());
    let plan = operator_plan(&scene.world).unwrap();
    let operator = Box::new(SimulatedOperator::new(OperatorConfig::default(), plan).unwrap());
    let on = Commands { enabled: true, ..Commands::default() };
    let mut servo = spawn(operator, move |input| tick.step(input), on, &LoopConfig::default()).unwrap();
    let (mut newest, mut since) = (0, Instant::now());
    while newest < TICKS {
        std::thread::sleep(Duration::from_millis(20));
        while let Some(record) = servo.records.pop() {
            (newest, since) = (record.input.sequence, Instant::now());
        }
        assert!(since.elapsed() < Duration::from_secs(60), "the loop stands still");
    }
    servo.handle.join().unwrap();
}

#[test]
fn the_servo_thread_only_sleeps() {
    let trace = tempfile::NamedTempFile::new().unwrap();
    let run = Command::new("strace")
        .args(["--follow-forks", "--decode-pids=comm", "--output"])
        .arg(trace.path())
        .arg(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "quiet_loop"])
        .output();
    let run = match run {
        Err(e) => return eprintln!("SKIPPED: strace is not installed ({e}); Debian: apt install strace"),
        Ok(run) => run,
    };
    let said = String::from_utf8_lossy(&run.stderr);
    if said.contains("PTRACE") || said.contains("ptrace") {
        return eprintln!("SKIPPED: tracing is not permitted here: {}", said.trim());
    }
    assert!(run.status.success(), "{said}");
    let text = std::fs::read_to_string(trace.path()).unwrap();
    let servo: Vec<String> = text.lines().filter(|l| l.contains("<servo>")).filter_map(call).collect();
    let first = servo.iter().position(|c| c == "clock_nanosleep").expect("the servo thread sleeps");
    let last = servo.iter().rposition(|c| c == "clock_nanosleep").unwrap();
    let mut calls: BTreeMap<&str, u32> = BTreeMap::new();
    for call in &servo[first..=last] {
        *calls.entry(call).or_default() += 1;
    }
    println!("system calls of the servo thread: {calls:?}");
    assert!(u64::from(calls["clock_nanosleep"]) >= TICKS, "{calls:?}");
    assert_eq!(calls.len(), 1, "{calls:?}");
}

/// The name of the call in a line such as `123<servo> clock_nanosleep(...) = 0` or `123<servo> <... clock_nanosleep resumed>`;
/// none where somebody stopped the process (`123<servo> --- SIGSTOP {...} ---`).
fn call(line: &str) -> Option<String> {
    let what = line.split_once("<servo>").map_or(line, |(_, rest)| rest).trim_start();
    let name = what.strip_prefix("<... ").unwrap_or(what);
    let name: String = name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    (!what.starts_with("---")).then_some(name)
}
