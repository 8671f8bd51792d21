//! The tick as a whole: safe states, no force jumps, determinism, energy.

use device::Sample;
use haptics::{Gains, LawKind};
use scene::Scene;
use servo::{Config, Health, Tick, TickInput, TickRecord};
use spatial::{DQuat, DVec3, Pose, Stamp, Twist, Wrench};
use std::path::Path;

const DT: f64 = 1e-3;
const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

fn scene(name: &str) -> Scene {
    Scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes").join(name).join("scene.yaml"))
        .unwrap()
}

fn input(i: u64, pose: Pose, gains: Gains) -> TickInput {
    let stamp = Stamp(i as i64 * 1_000_000);
    let sample = Sample { sequence: i + 1, stamp, pose, connected: true, ..Default::default() };
    TickInput { sequence: i, stamp, dt: DT, sample, gains, enabled: true, ..Default::default() }
}

/// The peg beside its hole, its lower end `depth` under the plate's top.
fn pressed(depth: f64) -> Pose {
    Pose::new(DVec3::new(0.018, 0.0, 0.015 - depth), Pose::IDENTITY.rotation)
}

/// A tick with the peg pressed 2 mm into the plate and the ramp over: 2 N.
fn settled(config: &Config) -> (Tick, u64) {
    let mut tick = Tick::new(&scene("peg_in_hole"), config);
    let n = 1000;
    for i in 0..n {
        let depth = (0.003 * (i as f64 / 300.0).min(1.0)) - 0.001;
        tick.step(&input(i, pressed(depth), config.gains));
    }
    let last = tick.step(&input(n, pressed(0.002), config.gains));
    assert!((last.out_wrench.force.z - 2.0).abs() < 0.05, "{:?}", last.out_wrench);
    assert_eq!(last.health, Health::GOOD);
    (tick, n + 1)
}

#[test]
fn force_is_zero_until_enabled_and_then_ramps() {
    let config = Config::default();
    let mut tick = Tick::new(&scene("peg_in_hole"), &config);
    for i in 0..100 {
        let r = tick.step(&TickInput { enabled: false, ..input(i, pressed(0.001), config.gains) });
        assert_eq!(r.out_wrench, Wrench::ZERO);
        assert!(r.law_wrench.force.z > 0.9);
    }
    let mut last = 0.0;
    for i in 100..800 {
        let r = tick.step(&input(i, pressed(0.001), config.gains));
        assert!(r.out_wrench.force.z - last < 0.01, "tick {i}: no step");
        last = r.out_wrench.force.z;
    }
    assert!((last - 1.0).abs() < 0.01);
}

#[test]
fn every_fault_takes_the_force_away_at_once_and_sets_its_bit() {
    type Fault = fn(&mut TickInput);
    let table: &[(Health, Fault)] = &[
        (Health::DISCONNECTED, |i| i.sample.connected = false),
        (Health::INVALID, |i| i.sample.pose.translation.x = f64::NAN),
        (Health::INVALID, |i| i.sample.pose.rotation.w = 2.0),
        (Health::STALE, |i| i.sample.stamp = Stamp(i.stamp.0 - 20_000_000)),
        (Health::FAULT, |i| i.dt = f64::NAN),
        (Health::FAULT, |i| i.remote.force.x = f64::INFINITY),
        (Health::FAULT, |i| i.gains.stiffness = f64::NAN),
        (Health::JUMP, |i| i.sample.pose.translation.x += 0.05),
        (Health::GOOD, |i| i.enabled = false),
    ];
    for (bit, fault) in table {
        let config = Config::default();
        let (mut tick, n) = settled(&config);
        let mut zero_after = None;
        for k in 0..15 {
            let mut bad = input(n + k, pressed(0.002), config.gains);
            // The sample that came before the silence stays the newest.
            fault(&mut bad);
            if *bit == Health::STALE {
                bad.sample = input(n - 1, pressed(0.002), config.gains).sample;
            }
            let r = tick.step(&bad);
            assert!(r.out_wrench.is_finite());
            if r.out_wrench == Wrench::ZERO {
                assert!(bit.0 == 0 || r.health.any(*bit), "{bit}: {}", r.health);
                zero_after.get_or_insert(k);
            }
            if *bit == Health::JUMP {
                break;
            }
        }
        let allowed = if *bit == Health::STALE { 10 } else { 0 };
        assert!(zero_after.is_some_and(|k| k <= allowed), "{bit}: {zero_after:?}");
        // And comes back by the ramp, not by a step.
        let r = tick.step(&input(n + 20, pressed(0.002), config.gains));
        assert!(r.out_wrench.force.length() < 0.1, "{bit}: {:?}", r.out_wrench);
    }
}

#[test]
fn a_dead_man_switch_released_takes_the_force_away() {
    let mut config = Config::default();
    config.mapping.deadman_button = 0;
    let mut tick = Tick::new(&scene("peg_in_hole"), &config);
    for i in 0..700 {
        let mut held = input(i, pressed(0.001), config.gains);
        held.sample.buttons = 1;
        let r = tick.step(&held);
        assert_eq!(r.health, Health::GOOD);
        if i == 699 {
            assert!(r.out_wrench.force.z > 0.9);
        }
    }
    let r = tick.step(&input(700, pressed(0.001), config.gains));
    assert_eq!((r.out_wrench, r.health), (Wrench::ZERO, Health::DEADMAN));
}

#[test]
fn gains_and_laws_change_without_a_jump() {
    let config = Config::default();
    let (mut tick, n) = settled(&config);
    let mut last = tick.step(&input(n, pressed(0.002), config.gains)).out_wrench;
    let mut gains = config.gains;
    let changes: [fn(&mut Gains); 5] = [
        |g| g.stiffness = 3000.0,
        |g| g.law = LawKind::Paper,
        |g| g.law = LawKind::Proxy,
        |g| g.max_force = 3.0,
        |g| g.passivity = false,
    ];
    for i in 0..1500 {
        if i % 300 == 0 {
            changes[i as usize / 300](&mut gains);
        }
        let r = tick.step(&input(n + 1 + i, pressed(0.002), gains));
        let step = (r.out_wrench.force - last.force).length();
        // Only a limit that is lowered holds at once.
        assert!(step < 0.15 || i == 900, "tick {i}: {step} N");
        // What was added to the hand's energy by a stiffer spring is owed when it is let go: the force does not fade meanwhile.
        assert!((r.out_wrench.force.z - 6.0).abs() < 0.02 || !(295..900).contains(&i), "tick {i}: {:?}", r.out_wrench);
        last = r.out_wrench;
    }
    assert!((last.force.z - 3.0).abs() < 1e-3, "limited to 3 N of 6: {last:?}");
}

#[test]
fn the_clutch_makes_no_force_jump() {
    let mut config = Config::default();
    config.mapping.clutch_button = 2;
    let (mut tick, n) = settled(&config);
    let mut last = tick.step(&input(n, pressed(0.002), config.gains));
    for i in 1..1500 {
        let clutched = i < 400;
        // The hand goes 50 mm away while it holds the clutch.
        let aside = DVec3::X * 1e-3 * (i as f64).min(50.0);
        let pose = Pose::new(pressed(0.002).translation + aside, Pose::IDENTITY.rotation);
        let mut next = input(n + i, pose, config.gains);
        next.sample.buttons = if clutched { 4 } else { 0 };
        let r = tick.step(&next);
        assert!((r.out_wrench.force - last.out_wrench.force).length() < 0.15);
        assert!((r.hip.translation - last.hip.translation).length() < 1e-12, "the part stays");
        if i == 100 {
            assert_eq!(r.out_wrench.force.length(), 0.0);
        }
        last = r;
    }
    assert!((last.out_wrench.force.z - 2.0).abs() < 0.05, "and the force comes back");
}

/// A wandering hand, in and out of contact, and everything that can happen to it.
fn eventful(seed: u64, law: LawKind) -> Vec<TickInput> {
    let mut state = seed;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let gains = Gains { law, ..Gains::default() };
    let mut pose = Pose::new(DVec3::Z * 0.02, Pose::IDENTITY.rotation);
    let mut v = Twist::ZERO;
    (0..3000)
        .map(|i| {
            let mut r3 = || DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5);
            let home = DVec3::Z * 0.012 - pose.translation;
            v.linear = v.linear * 0.995 + r3() * 0.01 + home * 0.02;
            v.angular = v.angular * 0.99 + r3() * 0.1 + pose.rotation_to(&Pose::IDENTITY) * 0.1;
            pose = pose.moved(v.linear * DT, v.angular * DT);
            let mut next = input(i, pose, gains);
            match (random() * 600.0) as u32 {
                0 => next.sample.connected = false,
                1 => next.sample.pose.translation.y = f64::NAN,
                2 => next.dt = 5e-3,
                3 => next.enabled = false,
                4 => next.reset_count = 1,
                5 => next.gains.law = LawKind::Pstar,
                _ => {}
            }
            next
        })
        .collect()
}

fn run(inputs: &[TickInput]) -> Vec<TickRecord> {
    let mut tick = Tick::new(&scene("peg_in_hole"), &Config::default());
    inputs.iter().map(|i| tick.step(i)).collect()
}

#[test]
fn the_same_inputs_give_the_same_bits() {
    for law in LAWS {
        let inputs = eventful(7, law);
        let (a, b) = (run(&inputs), run(&inputs));
        assert!(a.iter().any(|r| r.depth > 0.0), "{law:?}: some contact");
        for (x, y) in a.iter().zip(&b) {
            // Debug shows every bit of a number that matters, and NaN equals itself in it.
            assert_eq!(format!("{x:?}"), format!("{y:?}"), "{law:?}");
        }
    }
}

#[test]
fn whatever_happens_the_wrench_is_finite_and_within_its_limits() {
    for law in LAWS {
        for seed in 0..4 {
            let g = Gains::default();
            for r in run(&eventful(seed, law)) {
                assert!(r.out_wrench.is_finite() && r.depth >= 0.0 && r.proxy.is_valid() && r.energy.is_finite());
                assert!(r.out_wrench.force.length() <= g.max_force * (1.0 + 1e-12));
                assert!(r.out_wrench.torque.length() <= g.max_torque * (1.0 + 1e-12));
                assert!(!r.health.any(Health::ZERO_FORCE) || r.out_wrench == Wrench::ZERO);
            }
        }
    }
}

#[test]
fn free_motion_costs_nothing_however_the_part_is_turned() {
    // In most orientations a quaternion times its own inverse is no exact identity: that must not pass for contact.
    for law in LAWS {
        let config = Config { gains: Gains { law, ..Gains::default() }, ..Config::default() };
        for k in 0..50 {
            let mut tick = Tick::new(&scene("corner"), &config);
            let turn = DQuat::from_scaled_axis(DVec3::new(0.3, -0.7, 0.5) * f64::from(k));
            for i in 0..20 {
                let place = DVec3::new(0.05, 0.02, 0.2) + DVec3::new(1e-3, -2e-3, 1e-3) * i as f64;
                let r = tick.step(&input(i, Pose::new(place, turn), config.gains));
                assert_eq!((r.law_wrench, r.out_wrench), (Wrench::ZERO, Wrench::ZERO), "{law:?}, {turn}");
            }
        }
    }
}

#[test]
fn slow_closed_loops_of_every_law_take_no_energy_from_nowhere() {
    // Down into the plate, sideways, and out again on another path, without damping and controller.
    for law in LAWS {
        let gains =
            Gains { law, damping: 0.0, rotation_damping: 0.0, passivity: false, max_force: 50.0, ..Gains::default() };
        let config = Config { gains, ..Config::default() };
        let mut tick = Tick::new(&scene("peg_in_hole"), &config);
        let (mut given, mut peak) = (0.0, 0.0f64);
        let mut last: Option<TickRecord> = None;
        let n = 20_000;
        for i in 0..=n {
            let s = std::f64::consts::TAU * (f64::max(0.0, i as f64 - 1000.0) / (n as f64 - 1000.0));
            let p = DVec3::new(0.018 + 2e-3 * s.sin(), 0.0, 0.016 - 2e-3 * 0.5 * (1.0 - s.cos()));
            let r = tick.step(&input(i, Pose::new(p, Pose::IDENTITY.rotation), gains));
            if let Some(l) = last {
                // The trapezoidal rule: the loop's own energy, not that of its sampling.
                given += 0.5 * (l.out_wrench.force + r.out_wrench.force).dot(r.hip.translation - l.hip.translation);
                peak = peak.max(r.law_wrench.force.length());
            }
            last = Some(r);
        }
        assert!(peak > 0.9, "{law:?}: in contact");
        assert!(given.abs() < 1e-8, "{law:?}: {given} J");
    }
}

#[test]
fn a_hand_that_plunges_deep_and_turns_gets_back_no_more_than_it_put_in() {
    // Far beyond the greatest force and torque. While the hand only translates, its rotation still jitters in the last bits:
    // the stiffness in rotation, torque over turn, must not seem huge by that, and with it what a step of the encoders feigns.
    type Motion = (DVec3, [f64; 2], [f64; 3], [f64; 3]);
    let motions: [Motion; 3] = [
        (DVec3::new(-0.8, 0.6, 1.1), [1.2, 0.3], [1.2, 1.6, 5.1], [1.0, 7.0, 1.0]),
        (DVec3::new(-1.0, -0.3, 0.2), [0.5, 0.4], [3.0, 2.4, 4.5], [7.0, 6.0, 3.0]),
        (DVec3::new(-1.2, -0.7, -0.9), [1.7, 0.2], [5.9, 3.6, 4.1], [4.0, 1.0, 6.0]),
    ];
    for (axis, turn, phase, rate) in motions {
        for law in LAWS {
            let config = Config { gains: Gains { law, stiffness: 3000.0, ..Gains::default() }, ..Config::default() };
            let mut tick = Tick::new(&scene("corner"), &config);
            let pose = |i: u64| {
                // From above while the force ramps up, then about in the corner.
                let (above, s) = (0.1 * 700_u64.saturating_sub(i) as f64 / 700.0, 6e-3 * i.saturating_sub(700) as f64);
                let jitter = if i.is_multiple_of(2) { 1e-15 } else { 0.0 };
                let swing = |k: usize| (rate[k] * s + phase[k]).sin();
                let place = DVec3::new(0.01 * swing(0) - 0.02, 0.01 * swing(1), 0.01 + above + 0.012 * swing(2));
                Pose::new(place, DQuat::from_axis_angle(axis.normalize(), turn[0] + turn[1] * s.sin() + jitter))
            };
            let (mut given, mut most, mut put_in) = (0.0_f64, 0.0_f64, 0.0_f64);
            let mut shown = Wrench::ZERO;
            for i in 0..1700 {
                let (last, now) = (pose(i.max(1) - 1), pose(i));
                given += shown.force.dot(now.translation - last.translation);
                given += shown.torque.dot(last.rotation_to(&now));
                most = most.max(given);
                put_in = put_in.max(-given);
                shown = tick.step(&input(i, now, config.gains)).out_wrench;
            }
            assert!(put_in > 0.1, "{law:?}, {axis}: {put_in} J");
            assert!(most <= 1e-6, "{law:?}, {axis}: {most} J of {put_in} J");
        }
    }
}
