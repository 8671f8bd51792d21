//! A face at rest on a floor, pressed by the hand without tremor: no limit cycle in the torque.

use haptics::LawKind;
use scene::Scene;
use servo::{Config, Tick, TickInput};
use spatial::{DVec3, Pose, Stamp, Wrench};
use std::path::Path;

/// Ticks in the spectrum, one second, after two seconds of settling.
const WINDOW: usize = 1000;

/// A hand that holds the part: mass 0.2 kg, 4 N.s/m and 200 N/m to where it wants to be; 2e-4 kg.m2, 2e-3 N.m.s/rad and
/// 0.3 N.m/rad to the orientation it wants. Steps of a tenth of a millisecond.
struct Hand {
    pose: Pose,
    linear: DVec3,
    angular: DVec3,
}

impl Hand {
    fn move_on(&mut self, wish: &Pose, wrench: &Wrench) {
        let h = 1e-4;
        for _ in 0..10 {
            let pull = (wish.translation - self.pose.translation) * 200.0 - self.linear * 4.0 + wrench.force;
            let turn = self.pose.rotation_to(wish) * 0.3 - self.angular * 2e-3 + wrench.torque;
            self.linear += pull * (h / 0.2);
            self.angular += turn * (h / 2e-4);
            self.pose = self.pose.moved(self.linear * h, self.angular * h);
        }
    }
}

/// The torque on the hand over the last second, N.m, while the peg stands on the plate beside its hole.
fn torque_at_rest(law: LawKind) -> Vec<DVec3> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    let scene = Scene::load(&path).expect("the repository's scene");
    let mut config = Config::default();
    config.gains.law = law;
    let mut tick = Tick::new(&scene, &config);
    // Half a degree askew above the plate, then pressed 10 mm into it: 2 N.
    let start = Pose::from_xyz_rpy(DVec3::new(0.018, 0.003, 0.0165), DVec3::new(0.008, 0.005, 0.0));
    let wish = Pose::from_xyz_rpy(DVec3::new(0.018, 0.003, 0.005), DVec3::new(0.008, 0.005, 0.0));
    let mut hand = Hand { pose: start, linear: DVec3::ZERO, angular: DVec3::ZERO };
    let mut torque = Vec::with_capacity(WINDOW);
    for i in 0..(2000 + WINDOW) as u64 {
        let stamp = Stamp(1_000_000 * (i as i64 + 1));
        let sample = device::Sample { sequence: i + 1, stamp, pose: hand.pose, connected: true, ..Default::default() };
        let input = TickInput {
            sequence: i,
            stamp,
            dt: 1e-3,
            sample,
            gains: config.gains,
            enabled: true,
            ..Default::default()
        };
        let record = tick.step(&input);
        hand.move_on(&wish, &record.out_wrench);
        if i >= 2000 {
            assert!(record.out_wrench.force.z > 1.0, "{law:?} rests on the plate: {:?}", record.out_wrench);
            torque.push(record.out_wrench.torque);
        }
    }
    torque
}

/// The largest amplitude (N.m) of a line between 2 Hz and half the rate, and its frequency (Hz), over the three axes.
fn strongest_line(torque: &[DVec3]) -> (f64, usize) {
    let n = torque.len();
    let mean = torque.iter().sum::<DVec3>() / n as f64;
    let mut strongest = (0.0, 0);
    for k in 2..n / 2 {
        let (mut cosine, mut sine) = (DVec3::ZERO, DVec3::ZERO);
        for (i, t) in torque.iter().enumerate() {
            let phase = std::f64::consts::TAU * (k * i % n) as f64 / n as f64;
            cosine += (*t - mean) * phase.cos();
            sine += (*t - mean) * phase.sin();
        }
        let amplitude = (cosine.length_squared() + sine.length_squared()).sqrt() * 2.0 / n as f64;
        if amplitude > strongest.0 {
            strongest = (amplitude, k);
        }
    }
    strongest
}

#[test]
fn a_face_at_rest_does_not_buzz() {
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
        let torque = torque_at_rest(law);
        let mean = torque.iter().map(|t| t.length()).sum::<f64>() / torque.len() as f64;
        let (line, hz) = strongest_line(&torque);
        println!("{law:?}: torque {mean:.2e} N.m, strongest line {line:.1e} N.m at {hz} Hz");
        if matches!(law, LawKind::Blended | LawKind::Proxy) {
            assert!(line < 1e-5, "{law:?}: {line} N.m at {hz} Hz");
        } else {
            assert!(line > 1e-3, "{law:?}: the limit cycle of the single contact shows up: {line} N.m");
        }
    }
}
