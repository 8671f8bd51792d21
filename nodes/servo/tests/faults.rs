//! Faults, injected into a loop with the real tick while the hand feels a force: how soon the force is gone, which bit
//! says so, and whether the force comes back. `cargo test -p servo --test faults -- --nocapture` prints the table.

use device::{DeviceSpec, HapticDevice, Sample};
use realtime::{ThreadSetup, monotonic_ns};
use scene::Scene;
use servo::{Commands, Config, Health, LoopConfig, Tick, TickInput, TickRecord, spawn};
use spatial::{DQuat, DVec3, Pose, Stamp, Wrench};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Ticks that a fault lasts.
const LASTS: u32 = 60;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    Unplugged,
    Frozen,
    BadQuaternion,
    NanPose,
    NanTwist,
    Teleport,
    /// Another sample under the number and stamp of the last.
    Duplicate,
    OutOfOrder,
    OldStamp,
}

/// What the device saw: when the fault began, and the writes from then on.
#[derive(Default)]
struct Log {
    began_ns: Option<i64>,
    began_tick: u64,
    reads: u64,
    zero_ns: Option<i64>,
    largest_after: f64,
}

/// A hand that presses the peg 1 mm into the plate, until force is felt; then the fault.
struct Patient {
    spec: DeviceSpec,
    fault: Fault,
    sequence: u64,
    felt_for: u32,
    faulty_for: u32,
    last_good: Sample,
    log: Arc<Mutex<Log>>,
}

impl Patient {
    fn good(&mut self, now: Stamp) -> Sample {
        self.sequence += 1;
        let pose = Pose::new(DVec3::new(0.019, 0.0, 0.014), DQuat::IDENTITY);
        Sample { sequence: self.sequence, stamp: now, pose, has_twist: true, connected: true, ..Sample::default() }
    }

    fn spoil(&self, good: Sample) -> Sample {
        let last = self.last_good;
        match self.fault {
            Fault::Unplugged => Sample { connected: false, ..good },
            Fault::Frozen => last,
            Fault::BadQuaternion => {
                let rotation = DQuat::from_xyzw(0.3, -2.0, 1e-3, 0.5);
                Sample { pose: Pose { rotation, ..good.pose }, ..good }
            }
            Fault::NanPose => Sample { pose: Pose { translation: DVec3::NAN, ..good.pose }, ..good },
            Fault::NanTwist => Sample { twist: spatial::Twist { linear: DVec3::NAN, ..good.twist }, ..good },
            Fault::Teleport => Sample { pose: Pose::new(DVec3::new(-0.019, 0.01, 0.013), DQuat::IDENTITY), ..good },
            Fault::Duplicate => {
                let pose = Pose { translation: good.pose.translation + DVec3::X * 1e-4, ..good.pose };
                Sample { sequence: last.sequence, stamp: last.stamp, pose, ..good }
            }
            Fault::OutOfOrder => Sample { sequence: last.sequence - 1, stamp: Stamp(last.stamp.0 - 1_000_000), ..good },
            Fault::OldStamp => Sample { stamp: Stamp(good.stamp.0 - 1_000_000_000), ..good },
        }
    }
}

impl HapticDevice for Patient {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read(&mut self, now: Stamp) -> Sample {
        let good = self.good(now);
        let mut log = self.log.lock().unwrap();
        log.reads += 1;
        if self.felt_for < 100 || self.faulty_for >= LASTS {
            self.last_good = good;
            return good;
        }
        self.faulty_for += 1;
        if log.began_ns.is_none() {
            log.began_ns = Some(monotonic_ns());
            log.began_tick = log.reads - 1;
        }
        drop(log);
        self.spoil(good)
    }

    fn write(&mut self, wrench: &Wrench) {
        let force = wrench.force.length();
        self.felt_for += u32::from(force > 0.3);
        let mut log = self.log.lock().unwrap();
        if log.began_ns.is_none() {
            return;
        }
        if *wrench == Wrench::ZERO && log.zero_ns.is_none() {
            log.zero_ns = Some(monotonic_ns());
        }
        log.largest_after = log.largest_after.max(force);
    }
}

struct Outcome {
    records: Vec<TickRecord>,
    began: usize,
    zero_ms: Option<f64>,
    largest_after: f64,
    /// Samples that the loop counted as repeated, and as bad.
    counted: (u64, u64),
}

/// Runs until well after the fault; force must be felt before it, or the test waits in vain.
fn inject(fault: Fault) -> Outcome {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    let mut config = Config::default();
    config.gains.ramp_time = 0.05;
    let mut tick = Tick::new(&Scene::load(&path).unwrap(), &config);
    let log = Arc::new(Mutex::new(Log::default()));
    let patient = Patient {
        spec: DeviceSpec::force_feedback("patient"),
        fault,
        sequence: 0,
        felt_for: 0,
        faulty_for: 0,
        last_good: Sample::default(),
        log: Arc::clone(&log),
    };
    let thread = ThreadSetup { priority: 0, cpu: -1, lock_memory: false };
    let settings = LoopConfig { thread, ..LoopConfig::default() };
    let on = Commands { enabled: true, gains: config.gains, ..Commands::default() };
    let mut servo = spawn(Box::new(patient), move |input| tick.step(input), on, &settings).unwrap();
    let mut records: Vec<TickRecord> = Vec::new();
    let deadline = Instant::now() + Duration::from_secs(30);
    loop {
        std::thread::sleep(Duration::from_millis(5));
        records.extend(std::iter::from_fn(|| servo.records.pop()));
        let log = log.lock().unwrap();
        if log.began_ns.is_some() && records.len() as u64 > log.began_tick + u64::from(LASTS) + 200 {
            break;
        }
        assert!(Instant::now() < deadline, "{fault:?}: no force was ever felt");
    }
    servo.handle.join().unwrap();
    let status = servo.status.read();
    let log = log.lock().unwrap();
    let began_ns = log.began_ns.unwrap();
    Outcome {
        began: log.began_tick as usize,
        zero_ms: log.zero_ns.map(|z| (z - began_ns) as f64 * 1e-6),
        largest_after: log.largest_after,
        counted: (status.samples_repeated, status.samples_bad),
        records,
    }
}

/// Ticks from the fault's first one until force is zero: 0 if in the very same tick.
fn ticks_to_zero(outcome: &Outcome) -> Option<usize> {
    outcome.records[outcome.began..].iter().position(|r| r.out_wrench == Wrench::ZERO)
}

fn print_row(fault: Fault, outcome: &Outcome, health: Health) {
    let time = outcome.zero_ms.map_or("stays on".to_owned(), |ms| format!("{ms:.2} ms"));
    let back = outcome.records.last().is_some_and(|r| r.out_wrench.force.length() > 0.3);
    println!("| {fault:?} | {time} | {health} | {} |", if back { "by itself, ramped" } else { "none" });
}

fn health_during(outcome: &Outcome) -> Health {
    outcome.records[outcome.began..outcome.began + LASTS as usize].iter().fold(Health::GOOD, |h, r| h | r.health)
}

/// The force must be zero within `ticks` of the fault, `bit` must be set, and the force must come back afterwards.
fn assert_cut(fault: Fault, ticks: usize, bit: Health) {
    let outcome = inject(fault);
    let health = health_during(&outcome);
    print_row(fault, &outcome, health);
    assert!(health.any(bit), "{fault:?}: health {health}");
    let took = ticks_to_zero(&outcome).unwrap_or_else(|| panic!("{fault:?}: the force stayed on"));
    assert!(took <= ticks, "{fault:?}: {took} ticks to zero");
    assert!(outcome.largest_after < 3.0, "{fault:?}: {} N after the fault", outcome.largest_after);
    let last = outcome.records.last().unwrap();
    assert!(last.out_wrench.force.length() > 0.3, "{fault:?}: the force did not come back, health {}", last.health);
}

#[test]
fn unplugged_force_is_zero_in_the_same_tick() {
    assert_cut(Fault::Unplugged, 0, Health::DISCONNECTED);
}

#[test]
fn frozen_force_is_zero_once_the_sample_is_stale() {
    // The time-out is 10 ms of age: ten more ticks, and one in which the age exceeds it.
    assert_cut(Fault::Frozen, 11, Health::STALE);
}

#[test]
fn garbage_force_is_zero_in_the_same_tick() {
    assert_cut(Fault::BadQuaternion, 0, Health::INVALID);
    assert_cut(Fault::NanPose, 0, Health::INVALID);
    assert_cut(Fault::NanTwist, 0, Health::INVALID);
}

#[test]
fn teleport_force_is_zero_and_ramps_anew() {
    assert_cut(Fault::Teleport, 0, Health::JUMP);
}

#[test]
fn duplicate_and_out_of_order_samples_are_not_used_and_go_stale() {
    assert_cut(Fault::Duplicate, 11, Health::STALE);
    assert_cut(Fault::OutOfOrder, 11, Health::SEQUENCE);
    assert_cut(Fault::OldStamp, 11, Health::STALE);
}

#[test]
fn samples_of_no_use_are_counted_once_each() {
    let lasts = u64::from(LASTS);
    assert_eq!(inject(Fault::NanPose).counted, (0, lasts));
    // The same wrong sample all the time; meanwhile the numbers of the good ones are skipped.
    assert_eq!(inject(Fault::Duplicate).counted, (1, lasts));
    assert_eq!(inject(Fault::OutOfOrder).counted.0, 1);
}

/// A tick over the scene, and a hand that presses 1 mm into the plate.
fn pressing() -> (Tick, Config, Pose) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    let mut config = Config::default();
    config.gains.ramp_time = 0.05;
    let tick = Tick::new(&Scene::load(&path).unwrap(), &config);
    (tick, config, Pose::new(DVec3::new(0.019, 0.0, 0.014), DQuat::IDENTITY))
}

#[test]
fn a_step_of_the_wall_clock_is_reported_and_the_force_survives_it() {
    for step_ns in [3_600_000_000_000, -3_600_000_000_000, 100_000_000, -100_000_000] {
        let (mut tick, config, pose) = pressing();
        let mut shift_ns = 0;
        let records: Vec<TickRecord> = (0..600u64)
            .map(|sequence| {
                let stepped = sequence == 300;
                shift_ns += if stepped { step_ns } else { 0 };
                let stamp = Stamp(1_700_000_000_000_000_000 + sequence as i64 * 1_000_000 + shift_ns);
                let sample = Sample {
                    sequence: sequence + 1,
                    stamp,
                    pose,
                    has_twist: true,
                    connected: true,
                    ..Sample::default()
                };
                tick.step(&TickInput {
                    sequence,
                    stamp,
                    dt: 0.001,
                    sample,
                    gains: config.gains,
                    enabled: true,
                    outside: if stepped { Health::CLOCK_STEP } else { Health::GOOD },
                    ..TickInput::default()
                })
            })
            .collect();
        let force = |n: usize| records[n].out_wrench.force.length();
        let lost = (300..600).filter(|n| force(*n) < 0.3).count();
        println!("| clock step {:+} s | {lost} ticks without force | {} |", step_ns as f64 * 1e-9, records[300].health);
        assert!(records[300].health.any(Health::CLOCK_STEP));
        assert!(force(299) > 0.3 && force(599) > 0.3, "{} N before, {} N after", force(299), force(599));
        assert!(lost < 100 && (0..600).all(|n| force(n) < 3.0));
    }
}

/// A busy thread at a higher priority on the servo's processor. Needs `SCHED_FIFO`.
#[test]
fn a_hog_at_higher_priority_makes_one_late_tick_and_no_burst() {
    let (mut tick, config, pose) = pressing();
    let patient = Patient {
        spec: DeviceSpec::force_feedback("patient"),
        fault: Fault::Frozen,
        sequence: 0,
        felt_for: 0,
        faulty_for: LASTS, // never faulty
        last_good: Sample { pose, ..Sample::default() },
        log: Arc::new(Mutex::new(Log::default())),
    };
    let thread = ThreadSetup { priority: 50, cpu: 0, lock_memory: false };
    let settings = LoopConfig { thread, ..LoopConfig::default() };
    let on = Commands { enabled: true, gains: config.gains, ..Commands::default() };
    let mut servo = spawn(Box::new(patient), move |input| tick.step(input), on, &settings).unwrap();
    if !servo.handle.grants().all_granted() {
        return eprintln!("SKIPPED: no real-time priority here: {}", servo.handle.grants());
    }
    let mut records = Vec::new();
    let mut run_on = |ticks: usize| {
        let (until, deadline) = (records.len() + ticks, Instant::now() + Duration::from_secs(30));
        while records.len() < until {
            assert!(Instant::now() < deadline, "the loop stands still");
            std::thread::sleep(Duration::from_millis(5));
            records.extend(std::iter::from_fn(|| servo.records.pop()));
        }
    };
    run_on(200);
    let hog = std::thread::spawn(|| {
        let _ = ThreadSetup { priority: 60, cpu: 0, lock_memory: false }.apply();
        let until_ns = monotonic_ns() + 20_000_000;
        while monotonic_ns() < until_ns {}
    });
    hog.join().unwrap();
    run_on(200);
    let status = servo.handle.join().unwrap();
    let latest = records.iter().max_by(|a, b| a.input.dt.total_cmp(&b.input.dt)).unwrap();
    println!("| CPU hog 20 ms | latest tick stands for {:.0} ms | {} |", latest.input.dt * 1e3, latest.health);
    assert!(latest.input.dt > 0.015 && latest.health.any(Health::LATE), "dt {}", latest.input.dt);
    assert!(status.skipped >= 15);
    // No burst: never two ticks for the same moment, and the force is there again.
    assert!(records.windows(2).all(|w| w[1].input.stamp > w[0].input.stamp));
    assert!(records.last().unwrap().out_wrench.force.length() > 0.3);
}
