//! The SpaceMouse driver, thread and all, on a bus of the test's own: plugged in, moved, pressed, unplugged.

use device::spacemouse::{HidBus, HidLink, LinkLost};
use device::{HapticDevice, Sample, SpaceMouse, SpaceMouseConfig};
use spatial::{Stamp, Wrench};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What the fake device does next.
#[derive(Default)]
struct Desk {
    plugged: bool,
    reports: VecDeque<Vec<u8>>,
    /// What it says whenever it has nothing else to say: a deflected cap reports again and again.
    held: Option<&'static [u8]>,
    written: Vec<Vec<u8>>,
}

#[derive(Clone, Default)]
struct FakeBus(Arc<Mutex<Desk>>);

impl HidBus for FakeBus {
    fn open(&mut self) -> Result<Box<dyn HidLink>, String> {
        let plugged = self.0.lock().unwrap().plugged;
        if plugged { Ok(Box::new(self.clone())) } else { Err("nothing plugged in".into()) }
    }
}

impl HidLink for FakeBus {
    fn read(&mut self, report: &mut [u8], _timeout: Duration) -> Result<usize, LinkLost> {
        std::thread::sleep(Duration::from_millis(1));
        let mut desk = self.0.lock().unwrap();
        if !desk.plugged {
            return Err(LinkLost("device disconnected".into()));
        }
        let next = desk.reports.pop_front().or(desk.held.map(<[u8]>::to_vec));
        let Some(bytes) = next else { return Ok(0) };
        report[..bytes.len()].copy_from_slice(&bytes);
        Ok(bytes.len())
    }

    fn write(&mut self, report: &[u8]) -> Result<(), LinkLost> {
        self.0.lock().unwrap().written.push(report.to_vec());
        Ok(())
    }
}

/// The device on a 1 kHz loop whose clock is the test's.
struct Bench {
    desk: Arc<Mutex<Desk>>,
    mouse: SpaceMouse,
    now: i64,
}

impl Bench {
    fn new() -> Self {
        let bus = FakeBus::default();
        let desk = Arc::clone(&bus.0);
        let mouse = SpaceMouse::on(Box::new(bus), SpaceMouseConfig::default()).unwrap();
        Self { desk, mouse, now: 1_000_000_000 }
    }

    fn plug(&self, plugged: bool) {
        self.desk.lock().unwrap().plugged = plugged;
    }

    fn report(&self, bytes: &[u8]) {
        self.desk.lock().unwrap().reports.push_back(bytes.to_vec());
    }

    fn hold(&self, report: Option<&'static [u8]>) {
        self.desk.lock().unwrap().held = report;
    }

    fn read(&mut self) -> Sample {
        self.now += 1_000_000;
        self.mouse.read(Stamp(self.now))
    }

    /// Reads on until `done`, 1 ms of the loop's time each.
    fn until(&mut self, what: &str, done: impl Fn(&Sample) -> bool) -> Sample {
        let deadline = Instant::now() + Duration::from_secs(20);
        loop {
            let sample = self.read();
            if done(&sample) {
                return sample;
            }
            assert!(Instant::now() < deadline, "waited 20 s for: {what}");
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

/// Cap pushed right, split format.
const RIGHT: [u8; 7] = [1, 0x5e, 1, 0, 0, 0, 0];
/// Cap pulled up (down is positive), combined format.
const UP: [u8; 13] = [1, 0, 0, 0, 0, 0xa2, 0xfe, 0, 0, 0, 0, 0, 0];

#[test]
fn plug_move_press_unplug_and_plug_again() {
    let mut bench = Bench::new();
    assert!(!bench.read().connected);
    let why = bench.mouse.monitor();
    bench.plug(true);
    bench.until("connection", |s| s.connected);

    bench.hold(Some(&RIGHT));
    bench.until("motion to the right", |s| s.pose.translation.x > 0.002 && s.twist.linear.x > 0.05);
    bench.hold(Some(&UP));
    bench.until("motion up", |s| s.pose.translation.z > 0.002);
    bench.report(&[3, 2, 0]);
    bench.until("the second button", |s| s.buttons == 2);

    bench.hold(None);
    bench.plug(false);
    let lost = bench.until("the loss", |s| !s.connected);
    bench.until("rest", |s| s.twist.linear.length() < 1e-6);
    assert!(why.notes().trouble.is_some_and(|t| t.contains("lost") || t.contains("plugged")));

    bench.plug(true);
    let back = bench.until("the return", |s| s.connected);
    assert_eq!(back.buttons, 0, "a button held at the unplugging is not held any more");
    let apart = (back.pose.translation - lost.pose.translation).length();
    assert!(apart < 0.02, "jumped {apart} m over the unplugging");
    assert_eq!(why.notes().plugged, 2);
    assert_eq!(why.notes().trouble, None);
}

#[test]
fn garbage_disconnects_until_a_sound_report() {
    let mut bench = Bench::new();
    bench.plug(true);
    bench.hold(Some(&RIGHT));
    bench.until("motion", |s| s.connected && s.twist.linear.x > 0.05);
    bench.hold(None);
    bench.report(&[1, 2, 3]);
    bench.until("refusal", |s| !s.connected);
    bench.until("rest", |s| s.twist.linear.length() < 1e-6);
    bench.hold(Some(&RIGHT));
    bench.until("motion again", |s| s.connected && s.twist.linear.x > 0.05);
    assert_eq!(bench.mouse.monitor().notes().garbage, 1);
}

#[test]
fn a_deflected_cap_that_falls_silent_counts_as_let_go() {
    let mut bench = Bench::new();
    bench.plug(true);
    bench.hold(Some(&RIGHT));
    bench.until("motion", |s| s.twist.linear.x > 0.05);
    bench.hold(None);
    bench.until("rest", |s| s.connected && s.twist.linear.length() < 1e-6);
}

#[test]
fn the_light_is_on_while_the_driver_holds_the_device() {
    let mut bench = Bench::new();
    bench.plug(true);
    bench.until("connection", |s| s.connected);
    let desk = Arc::clone(&bench.desk);
    assert_eq!(desk.lock().unwrap().written, [[4, 1]]);
    drop(bench);
    assert_eq!(desk.lock().unwrap().written, [[4, 1], [4, 0]]);
}

#[test]
fn it_says_that_it_shows_no_force() {
    let mut bench = Bench::new();
    assert_eq!((bench.mouse.spec().max_force, bench.mouse.spec().max_torque), (0.0, 0.0));
    bench.mouse.write(&Wrench::ZERO);
}

#[test]
fn without_any_device_it_says_so() {
    let mut mouse = SpaceMouse::start(SpaceMouseConfig::default()).unwrap();
    let why = mouse.monitor();
    let deadline = Instant::now() + Duration::from_secs(20);
    // Where a real one is plugged in, it is found instead.
    while why.notes().trouble.is_none() && why.notes().plugged == 0 {
        assert!(Instant::now() < deadline, "neither device nor reason");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(mouse.read(Stamp(1)).pose.is_valid());
}
