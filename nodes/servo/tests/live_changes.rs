//! What is changed live while the hand is in contact: the wrench does not jump, and the hand gets no energy.

use device::Sample;
use haptics::{Gains, LawKind};
use scene::Scene;
use servo::{Config, Tick, TickInput};
use spatial::{DQuat, DVec3, Pose, Stamp, Wrench};
use std::path::Path;

const DT: f64 = 1e-3;
const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

fn scene(name: &str) -> Scene {
    Scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes").join(name).join("scene.yaml"))
        .unwrap()
}

/// Into the corner, turned, a rest there, and out again on another path.
fn pose(i: u64) -> Pose {
    let s = |from: f64, to: f64| {
        let t = ((i as f64 - from) / (to - from)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let (inward, out) = (s(600.0, 1000.0), s(1600.0, 2000.0));
    let z = 0.04 - 0.035 * inward + 0.04 * out;
    let x = -0.005 * inward - 0.012 * (inward - out) + 0.01 * out;
    let turn = DVec3::new(0.05, -0.08, 0.02) * inward - DVec3::new(0.0, -0.04, 0.03) * out;
    Pose::new(DVec3::new(x, 0.0, z), DQuat::from_scaled_axis(turn))
}

/// What the hand felt.
#[derive(Default)]
struct Felt {
    /// Greatest change of force and torque in one tick while the hand rests, N and N.m.
    change: (f64, f64),
    /// Greatest force and torque meanwhile, N and N.m.
    most: (f64, f64),
    /// The most energy that it ever had got more than it had put in, J.
    given: f64,
    /// The most that it had put in, J.
    put_in: f64,
}

/// The motion with what `change` makes of the gains while the hand rests.
fn feel(gains: Gains, change: impl Fn(&mut Gains)) -> Felt {
    let config = Config { gains, ..Config::default() };
    let mut tick = Tick::new(&scene("corner"), &config);
    let mut felt = Felt::default();
    let (mut shown, mut given) = (Wrench::ZERO, 0.0);
    for i in 0..2200 {
        let (last, now) = (pose(i.max(1) - 1), pose(i));
        given += shown.force.dot(now.translation - last.translation) + shown.torque.dot(last.rotation_to(&now));
        felt.given = felt.given.max(given);
        felt.put_in = felt.put_in.max(-given);
        let stamp = Stamp(i as i64 * 1_000_000);
        let sample = Sample { sequence: i + 1, stamp, pose: now, connected: true, ..Sample::default() };
        let mut input = TickInput { sequence: i, stamp, dt: DT, sample, gains, enabled: true, ..TickInput::default() };
        if i >= 1200 {
            change(&mut input.gains);
        }
        let wrench = tick.step(&input).out_wrench;
        if (1100..1600).contains(&i) {
            let step = (wrench.force - shown.force, wrench.torque - shown.torque);
            felt.change = (felt.change.0.max(step.0.length()), felt.change.1.max(step.1.length()));
            felt.most = (felt.most.0.max(wrench.force.length()), felt.most.1.max(wrench.torque.length()));
        }
        shown = wrench;
    }
    felt
}

type Change = (&'static str, fn(&mut Gains));

/// Changes that a person may make at any time.
const CHANGES: &[Change] = &[
    ("paper", |g| g.law = LawKind::Paper),
    ("pstar", |g| g.law = LawKind::Pstar),
    ("blended", |g| g.law = LawKind::Blended),
    ("proxy", |g| g.law = LawKind::Proxy),
    ("five times as stiff", |g| g.stiffness *= 5.0),
    ("a fifth as stiff", |g| g.stiffness *= 0.2),
    ("five times as stiff in rotation", |g| g.rotation_stiffness *= 5.0),
    ("ten times the blend depth", |g| g.blend_depth *= 10.0),
    ("damping", |g| g.damping = 20.0),
    ("friction", |g| (g.friction_static, g.friction_kinetic) = (0.5, 0.5)),
    ("a slow proxy", |g| g.proxy_speed = 0.05),
];

#[test]
fn a_change_of_law_or_gains_in_contact_is_no_jump() {
    for law in LAWS {
        for (name, change) in CHANGES {
            // No limit cuts the wrench: a jump would show.
            let gains = Gains { law, max_force: 60.0, max_torque: 5.0, ..Gains::default() };
            let felt = feel(gains, change);
            assert!(felt.most.0 > 5.0 && felt.most.1 > 0.05, "{law:?}, {name}: {:?}", felt.most);
            let share = (felt.change.0 / felt.most.0, felt.change.1 / felt.most.1);
            // Gains come in by 2 % a tick; a torque that is blended changes by three times as much as the depth over which it is.
            assert!(share.0 < 0.02 && share.1 < 0.08, "{law:?}, {name}: {share:?} of the greatest in one tick");
        }
    }
}

#[test]
fn what_a_change_of_law_or_gains_stores_in_contact_is_not_given_to_the_hand() {
    for law in LAWS {
        for (name, change) in CHANGES {
            // With and without the limits in the way.
            for max_force in [10.0, 60.0] {
                let felt = feel(Gains { law, max_force, ..Gains::default() }, change);
                assert!(
                    felt.put_in > 0.03 && felt.given < 1e-6,
                    "{law:?}, {name}: {} of {} J",
                    felt.given,
                    felt.put_in
                );
            }
        }
    }
}
