//! Scripted motions: rendered at 1 kHz, cut into contact states, compared with the sequence that is known by construction.
#![allow(dead_code, reason = "each test takes what it needs")]

use bag::{FeatureBook, Segment, SegmentOptions, segments};
use cspace::{Polyhedron, World};
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use servo::{Health, TickInput, TickRecord};
use spatial::{DQuat, DVec3, Pose, Stamp, Twist, Wrench};
use std::sync::Arc;

pub const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

pub fn cuboid(low: [f64; 3], high: [f64; 3]) -> Polyhedron {
    let (low, high) = (DVec3::from(low), DVec3::from(high));
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let vertices: Vec<DVec3> = (0..8).map(corner).collect();
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|f| f.to_vec());
    Polyhedron::from_faces(&vertices, &faces).unwrap()
}

/// A piece of a script: where to be at its end, and after how many ms.
pub type Leg = ([f64; 3], u32);

/// Renders straight moves at 1 kHz with a fixed orientation; positions are those of A's centre.
pub fn run(world: &World, law: LawKind, rotation: DQuat, start: [f64; 3], legs: &[Leg]) -> Vec<TickRecord> {
    let mut renderer = Renderer::new(Arc::new(world.clone()));
    let gains = Gains { law, ..Gains::default() };
    let mut ticks = Vec::new();
    let mut from = DVec3::from(start);
    for &(to, ms) in legs {
        let to = DVec3::from(to);
        for k in 0..ms {
            let hip = Pose::new(from.lerp(to, f64::from(k) / f64::from(ms)), rotation);
            let out = renderer.render(&hip, &gains, 1e-3);
            let sequence = ticks.len() as u64;
            ticks.push(TickRecord {
                input: TickInput {
                    sequence,
                    stamp: Stamp(sequence as i64 * 1_000_000),
                    dt: 1e-3,
                    sample: device::Sample::default(),
                    gains,
                    enabled: true,
                    reset_count: 0,
                    outside: Health::GOOD,
                    remote: Wrench::ZERO,
                },
                hip,
                twist: Twist { linear: (to - from) / (f64::from(ms) * 1e-3), angular: DVec3::ZERO },
                proxy: out.proxy,
                depth: out.depth,
                formation: out.formation,
                law_wrench: out.wrench,
                out_wrench: out.wrench,
                energy: 0.0,
                health: Health::GOOD,
                wakeup_ns: 0,
                compute_ns: 0,
            });
        }
        from = to;
    }
    ticks
}

/// Formation, number of principal contacts, and begin in s of each expected state.
pub fn check(world: &World, name: &str, ticks: &[TickRecord], expected: &[(&str, usize, f64)]) -> Vec<Segment> {
    let found = segments(ticks, SegmentOptions::default(), Some(FeatureBook::new(world)));
    let shown: Vec<_> = found.iter().map(|s| (s.kind.name(), s.label(), s.begin.as_secs_f64())).collect();
    assert_eq!(found.len(), expected.len(), "{name}: {shown:#?}");
    for (i, (segment, (kind, contacts, begin))) in found.iter().zip(expected).enumerate() {
        assert_eq!((segment.kind.name(), segment.contacts.len()), (*kind, *contacts), "{name}: state {i}: {shown:#?}");
        let late = segment.begin.as_secs_f64() - begin;
        assert!(late.abs() <= 3e-3, "{name}: state {i} begins {late} s off: {shown:#?}");
        if let Some(next) = found.get(i + 1) {
            assert!((segment.end.0 - next.begin.0).abs() <= 3_000_000, "{name}: state {i}: {shown:#?}");
        }
    }
    found
}
