//! The loop with a device and a tick of the test's own: what reaches the device, what reaches the rings.

use device::{DeviceSpec, HapticDevice, Sample};
use realtime::{ThreadSetup, monotonic_ns};
use servo::{Commands, Health, LoopConfig, LoopError, TickInput, TickRecord, spawn};
use spatial::{DVec3, Stamp, Wrench};
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Remembers the last wrench and when it was written.
struct Probe {
    spec: DeviceSpec,
    reads: u64,
    written: Arc<Mutex<(Wrench, i64)>>,
}

fn probe() -> (Box<Probe>, Arc<Mutex<(Wrench, i64)>>) {
    let written = Arc::new(Mutex::new((Wrench::ZERO, 0)));
    let spec = DeviceSpec {
        name: "probe".into(),
        workspace: DVec3::ONE,
        max_force: 10.0,
        max_torque: 1.0,
        max_stiffness: 1000.0,
        resolution: 1e-5,
        mass: 0.1,
        damping: 0.1,
    };
    (Box::new(Probe { spec, reads: 0, written: Arc::clone(&written) }), written)
}

impl HapticDevice for Probe {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read(&mut self, now: Stamp) -> Sample {
        self.reads += 1;
        Sample { sequence: self.reads, stamp: now, connected: true, ..Default::default() }
    }

    fn write(&mut self, wrench: &Wrench) {
        *self.written.lock().unwrap() = (*wrench, monotonic_ns());
    }
}

/// Unprivileged, so that the test says the same everywhere.
fn config(rate_hz: f64) -> LoopConfig {
    LoopConfig { rate_hz, thread: ThreadSetup { priority: 0, cpu: -1, lock_memory: false }, ring_capacity: 4096 }
}

fn push_when_enabled(input: &TickInput) -> TickRecord {
    let force = if input.enabled { DVec3::X * input.gains.stiffness } else { DVec3::ZERO };
    TickRecord {
        input: *input,
        health: input.outside,
        out_wrench: Wrench::new(force, DVec3::ZERO),
        ..Default::default()
    }
}

const PATIENCE: Duration = Duration::from_secs(30);

fn wait_until(mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + PATIENCE;
    while !done() {
        assert!(Instant::now() < deadline, "waited {PATIENCE:?} in vain");
        std::thread::sleep(Duration::from_micros(200));
    }
}

#[test]
fn every_tick_reaches_both_rings_in_order_on_an_even_grid() {
    for rate_hz in [250.0, 1000.0, 4000.0] {
        let (device, _) = probe();
        // The hundredth tick ends when the loop has been told to stop: no ring fills, however late this thread is.
        let ((say, hundredth), (told, wait)) = (channel(), channel());
        let step = move |input: &TickInput| {
            if input.sequence == 99 {
                let _ = say.send(());
                let _ = wait.recv_timeout(PATIENCE);
            }
            push_when_enabled(input)
        };
        let mut servo = spawn(device, step, Commands::default(), &config(rate_hz)).unwrap();
        hundredth.recv_timeout(PATIENCE).unwrap();
        servo.handle.stop();
        told.send(()).unwrap();
        let status = servo.handle.join().unwrap();
        let records: Vec<TickRecord> = std::iter::from_fn(|| servo.records.pop()).collect();
        let pictures: Vec<TickRecord> = std::iter::from_fn(|| servo.pictures.pop()).collect();
        assert_eq!(records, pictures);
        assert_eq!((status.ticks, records.len()), (100, 100));
        assert_eq!(status.wakeup.summary().count, status.ticks);
        for (n, pair) in records.windows(2).enumerate() {
            let [a, b] = [&pair[0].input, &pair[1].input];
            assert_eq!((a.sequence, b.sequence), (n as u64, n as u64 + 1));
            // The stamps say the same as dt, but for the slow following of the wall clock.
            let gap = (b.stamp.0 - a.stamp.0) as f64 * 1e-9;
            let even = (gap / b.dt - 1.0).abs() < 0.01;
            assert!(even || b.outside.any(Health::CLOCK_STEP), "{gap} s between stamps, dt {}", b.dt);
            let periods = b.dt * rate_hz;
            assert!((periods - periods.round()).abs() < 1e-9);
            assert_eq!(periods > 1.5, b.outside.any(Health::LATE));
        }
    }
}

#[test]
fn commands_arrive_and_stopping_takes_the_force_away() {
    for rate_hz in [250.0, 1000.0] {
        let (device, written) = probe();
        let mut servo = spawn(device, push_when_enabled, Commands::default(), &config(rate_hz)).unwrap();
        wait_until(|| written.lock().unwrap().1 != 0);
        assert_eq!(written.lock().unwrap().0, Wrench::ZERO);
        servo.commands.write(Commands { enabled: true, ..Default::default() });
        wait_until(|| written.lock().unwrap().0.force.x > 0.0);
        let asked_ns = monotonic_ns();
        servo.handle.stop();
        wait_until(|| !servo.handle.is_running());
        let (wrench, at_ns) = *written.lock().unwrap();
        assert_eq!(wrench, Wrench::ZERO);
        println!("{rate_hz} Hz: force off {:.2} ms after stop()", (at_ns - asked_ns) as f64 * 1e-6);
        servo.handle.join().unwrap();
    }
}

#[test]
fn dropping_the_handle_stops_the_loop() {
    let (device, written) = probe();
    let on = Commands { enabled: true, ..Default::default() };
    let servo = spawn(device, push_when_enabled, on, &config(1000.0)).unwrap();
    wait_until(|| written.lock().unwrap().0.force.x > 0.0);
    drop(servo);
    assert_eq!(written.lock().unwrap().0, Wrench::ZERO);
}

#[test]
fn full_rings_are_counted_and_the_loop_goes_on() {
    let (device, _) = probe();
    let small = LoopConfig { ring_capacity: 16, ..config(1000.0) };
    let mut servo = spawn(device, push_when_enabled, Commands::default(), &small).unwrap();
    wait_until(|| servo.records.dropped() > 20);
    let kept: Vec<TickRecord> = std::iter::from_fn(|| servo.records.pop()).collect();
    assert!(kept.iter().zip(0..).take(16).all(|(r, n)| r.input.sequence == n), "the oldest are kept");
    // The record after a full ring says so.
    let mut seen = false;
    wait_until(|| {
        seen |= std::iter::from_fn(|| servo.records.pop()).any(|r| r.health.any(Health::RING_FULL));
        seen
    });
    let status = servo.handle.join().unwrap();
    assert!(status.records_dropped > 20 && status.pictures_dropped > 20);
}

#[test]
fn a_tick_that_overruns_is_followed_by_one_late_tick_and_no_burst() {
    let (device, _) = probe();
    let step = |input: &TickInput| {
        if input.sequence == 20 {
            let until_ns = monotonic_ns() + 10_500_000;
            while monotonic_ns() < until_ns {}
        }
        push_when_enabled(input)
    };
    let mut servo = spawn(device, step, Commands::default(), &config(1000.0)).unwrap();
    let mut records = Vec::new();
    wait_until(|| {
        records.extend(std::iter::from_fn(|| servo.records.pop()));
        records.len() >= 60
    });
    let late = &records[21].input;
    assert!(late.outside.any(Health::LATE) && late.dt > 0.009, "dt {}", late.dt);
    assert!(records[21].wakeup_ns >= 9_000_000);
    let elapsed: f64 = records[21..=50].iter().map(|r| r.input.dt).sum();
    assert!(elapsed > 0.038, "30 ticks in {elapsed} s: a burst");
    assert!(servo.handle.join().unwrap().skipped >= 9);
}

#[test]
fn a_panic_in_the_tick_leaves_the_device_without_force_and_is_told() {
    let (device, written) = probe();
    let on = Commands { enabled: true, ..Default::default() };
    let step = |input: &TickInput| {
        assert!(input.sequence < 30, "the tick broke");
        push_when_enabled(input)
    };
    let servo = spawn(device, step, on, &config(1000.0)).unwrap();
    wait_until(|| !servo.handle.is_running());
    assert_eq!(written.lock().unwrap().0, Wrench::ZERO);
    let error = servo.handle.join().unwrap_err();
    assert!(matches!(&error, LoopError::Panicked(why) if why.contains("the tick broke")), "{error}");
}

#[test]
fn rates_and_capacities_out_of_range_are_refused() {
    for rate_hz in [0.0, 249.0, 10_001.0, f64::NAN, f64::INFINITY, -1000.0] {
        let error = spawn(probe().0, push_when_enabled, Commands::default(), &config(rate_hz)).unwrap_err();
        assert!(matches!(error, LoopError::Rate(_)));
    }
    let none = LoopConfig { ring_capacity: 0, ..config(1000.0) };
    assert!(matches!(spawn(probe().0, push_when_enabled, Commands::default(), &none), Err(LoopError::Capacity(0))));
}
