//! Ticks for the tests: a run that touches every field.
#![allow(dead_code, reason = "each test takes what it needs")]

use bag::msg::{SceneDescription, ServoConfiguration};
use cspace::BasicContact;
use haptics::{ContactPoint, FormationKind, LawKind};
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use servo::{Health, TickInput, TickRecord};
use spatial::{DQuat, DVec3, Pose, Stamp, Twist, Wrench};

/// 2023-11-14 22:13:20 UTC.
pub const EPOCH: i64 = 1_700_000_000_000_000_000;

/// Ticks at 1 kHz with every field filled from the seed.
pub fn ticks(n: u64, seed: u64) -> Vec<TickRecord> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    (0..n).map(|i| tick(i, &mut rng)).collect()
}

fn vector(rng: &mut impl Rng) -> DVec3 {
    DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0))
}

fn pose(rng: &mut impl Rng) -> Pose {
    Pose::new(vector(rng), DQuat::from_scaled_axis(vector(rng)))
}

fn wrench(rng: &mut impl Rng) -> Wrench {
    Wrench::new(vector(rng), vector(rng))
}

fn tick(sequence: u64, rng: &mut impl Rng) -> TickRecord {
    let stamp = Stamp(EPOCH + sequence as i64 * 1_000_000);
    let mut gains = haptics::Gains { stiffness: rng.random_range(1.0..1e4), ..haptics::Gains::default() };
    gains.law = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy][(sequence % 4) as usize];
    let mut formation = haptics::ContactFormation::FREE;
    for k in 0..(sequence % 17) as u32 {
        let letter = ['A', 'B', 'C'][(k % 3) as usize];
        formation.push(ContactPoint {
            part_a: k,
            piece_b: k + 1,
            contact: BasicContact::from_parts(letter, k + 2, k + 3).unwrap(),
            point_w: vector(rng),
            normal_w: vector(rng).normalize(),
            distance: -rng.random_range(0.0..1e-3),
            kind: FormationKind::EdgeFace,
        });
        formation.kind = FormationKind::FaceFace;
    }
    TickRecord {
        input: TickInput {
            sequence,
            stamp,
            dt: 1e-3,
            sample: device::Sample {
                sequence: sequence + 1,
                stamp: Stamp(stamp.0 - 12_345),
                pose: pose(rng),
                twist: Twist { linear: vector(rng), angular: vector(rng) },
                has_twist: sequence.is_multiple_of(2),
                buttons: rng.random(),
                connected: !sequence.is_multiple_of(3),
            },
            gains,
            enabled: !sequence.is_multiple_of(5),
            reset_count: rng.random(),
            outside: Health(rng.random()),
            remote: wrench(rng),
        },
        hip: pose(rng),
        twist: Twist { linear: vector(rng), angular: vector(rng) },
        proxy: pose(rng),
        depth: rng.random(),
        formation,
        law_wrench: wrench(rng),
        out_wrench: wrench(rng),
        energy: -rng.random_range(0.0..1.0),
        health: Health(rng.random()),
        wakeup_ns: rng.random(),
        compute_ns: rng.random(),
    }
}

/// A scene with one mesh.
pub fn scene() -> SceneDescription {
    SceneDescription::new("peg_in_hole", "world", "name: peg_in_hole\n", [("peg.obj", *b"v 0 0 0\n")])
}

/// A configuration.
pub fn configuration() -> ServoConfiguration {
    ServoConfiguration::new("peg_in_hole", "world", "law: proxy\n")
}
