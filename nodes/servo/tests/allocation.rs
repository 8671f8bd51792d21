//! The loop allocates nothing: every law, through contact, insertion, faults and resets, and on its real thread.

use device::{HapticDevice, OperatorConfig, SimulatedOperator};
use haptics::LawKind;
use realtime::ThreadSetup;
use scene::Scene;
use servo::{Commands, Config, Health, LoopConfig, Tick, TickInput, TickRecord, operator_plan, spawn};
use spatial::{DVec3, Pose, Stamp};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

thread_local! {
    /// Allocations, releases and resizings of this thread.
    static CALLS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn count() {
    // During a thread's end its counter is gone; nothing is measured there.
    let _ = CALLS.try_with(|calls| calls.set(calls.get() + 1));
}

#[allow(unsafe_code)]
// SAFETY: every call goes to the system's allocator unchanged; counting touches a thread-local cell that needs no
// allocation (const initialiser, no destructor).
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promises about `layout` are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count();
        // SAFETY: `pointer` came from `System` by `alloc` or `realloc` above, with this layout.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as for `dealloc`, and the caller's promises about `size` are passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

fn calls() -> u64 {
    CALLS.with(Cell::get)
}

const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

fn load(name: &str) -> Scene {
    Scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../config/scenes/{name}/scene.yaml"))).unwrap()
}

fn operator(scene: &Scene) -> SimulatedOperator {
    SimulatedOperator::new(OperatorConfig::default(), operator_plan(&scene.world).unwrap()).unwrap()
}

/// Ten seconds of a hand in a scene; some samples are broken on the way.
fn ten_seconds(scene: &Scene, law: LawKind) -> (u64, u32) {
    let mut config = Config::default();
    config.gains.law = law;
    let mut tick = Tick::new(scene, &config);
    let mut hand = operator(scene);
    let (mut contacts, before) = (0, calls());
    for n in 0..10_000u64 {
        let stamp = Stamp(1_000_000_000 + n as i64 * 1_000_000);
        let mut sample = hand.read(stamp);
        match n % 1000 {
            700 => sample.pose.translation = DVec3::NAN,
            710 => sample.connected = false,
            720 => sample.pose = Pose::new(sample.pose.translation + DVec3::X, sample.pose.rotation),
            730 => sample.sequence = 1,
            _ => {}
        }
        let input = TickInput {
            sequence: n,
            stamp,
            dt: if n % 500 == 3 { 0.02 } else { 0.001 },
            sample,
            gains: config.gains,
            enabled: n % 4000 > 10,
            reset_count: (n / 3000) as u32,
            outside: if n % 77 == 0 { Health::LATE } else { Health::GOOD },
            ..TickInput::default()
        };
        let record = tick.step(&input);
        hand.write(&record.out_wrench);
        contacts += u32::from(!record.formation.points().is_empty());
    }
    (calls() - before, contacts)
}

#[test]
fn no_law_allocates_in_ten_seconds_of_contact() {
    for name in ["peg_in_hole", "tetra_on_box"] {
        let scene = load(name);
        for law in LAWS {
            let (allocations, contacts) = ten_seconds(&scene, law);
            assert!(contacts > 1000, "{name}, {law:?}: only {contacts} ticks in contact");
            assert_eq!(allocations, 0, "{name}, {law:?}");
        }
    }
}

#[test]
fn the_servo_thread_allocates_nothing_between_its_first_and_last_tick() {
    let scene = load("peg_in_hole");
    let mut tick = Tick::new(&scene, &Config::default());
    let (first, total) = (Arc::new(AtomicU64::new(u64::MAX)), Arc::new(AtomicU64::new(0)));
    let (first_in, total_in) = (Arc::clone(&first), Arc::clone(&total));
    let step = move |input: &TickInput| -> TickRecord {
        let record = tick.step(input);
        first_in.fetch_min(calls(), Ordering::Relaxed);
        total_in.store(calls(), Ordering::Relaxed);
        record
    };
    let settings = LoopConfig {
        rate_hz: 4000.0,
        thread: ThreadSetup { priority: 0, cpu: -1, lock_memory: false },
        ..LoopConfig::default()
    };
    let on = Commands { enabled: true, ..Commands::default() };
    let mut servo = spawn(Box::new(operator(&scene)), step, on, &settings).unwrap();
    let (mut newest, mut since) = (0, Instant::now());
    // Long enough for two publications of the histograms.
    while newest <= 6000 {
        std::thread::sleep(Duration::from_millis(20));
        while servo.pictures.pop().is_some() {}
        while let Some(record) = servo.records.pop() {
            (newest, since) = (record.input.sequence, Instant::now());
        }
        assert!(since.elapsed() < Duration::from_secs(60), "the loop stands still");
    }
    assert!(servo.status.read().ticks > 2000);
    servo.handle.join().unwrap();
    assert_eq!(total.load(Ordering::Relaxed) - first.load(Ordering::Relaxed), 0);
}
