//! What steps cost while sliding: planes looked at and CPU time, without criterion's machinery, so that an instruction
//! counter can be put on it: `cargo run --release -p cspace --example step_cost -- [gap, m] [faces] [m/s]`. Without a speed
//! the poses are those of the bench; with one, a hand's at 1 kHz that turns by 10 rad/s for each m/s.

#[path = "../tests/support/mod.rs"]
mod support;

use cspace::Tracker;
use spatial::{DVec3, Pose};
use std::hint::black_box;
use std::time::Instant;
use support::motions::{sliding, sliding_by_hand};
use support::*;

/// One pass over the poses: what `valgrind --tool=callgrind --toggle-collect='*one_pass*'` counts.
#[inline(never)]
fn one_pass(tracker: &mut Tracker, poses: &[Pose]) {
    for pose in poses {
        black_box(tracker.step(black_box(pose)));
    }
}

fn main() {
    let mut args = std::env::args().skip(1);
    let gap = args.next().and_then(|a| a.parse().ok()).unwrap_or(-0.001);
    let only: Option<u32> = args.next().and_then(|a| a.parse().ok());
    let speed: Option<f64> = args.next().and_then(|a| a.parse().ok());
    let shapes = |faces: u32| match faces {
        4 => (tetrahedron(0.04), cuboid(DVec3::splat(0.1))),
        6 => (cuboid(DVec3::new(0.06, 0.08, 0.1)), cuboid(DVec3::new(0.1, 0.09, 0.12))),
        n => (ball(n as usize, 0.05), ball(n as usize, 0.06)),
    };
    for faces in [4, 6, 36, 200, 2000, 20_000] {
        if only.is_some_and(|o| o != faces) {
            continue;
        }
        let (a, b) = shapes(faces);
        let poses = match speed {
            Some(v) => sliding_by_hand(&a, &b, gap, 4000, 1e-3 * v, 1e-2 * v),
            None => sliding(&a, &b, gap, 4000),
        };
        let fresh = Tracker::new(polyhedron(&a), polyhedron(&b));
        let mut best = f64::INFINITY;
        for _ in 0..7 {
            let mut tracker = fresh.clone();
            let start = Instant::now();
            one_pass(&mut tracker, &poses);
            best = best.min(start.elapsed().as_nanos() as f64 / poses.len() as f64);
        }
        let mut tracker = fresh.clone();
        let mut planes: Vec<u32> = poses.iter().map(|p| tracker.step(p).planes).collect();
        planes.sort_unstable();
        let mean = planes.iter().map(|p| f64::from(*p)).sum::<f64>() / planes.len() as f64;
        let audits = planes.iter().filter(|p| **p > 5).count();
        println!(
            "{faces:>6} faces: {best:7.1} ns a step, planes mean {mean:.2} median {} max {}, {audits} steps look at more than 5",
            planes[planes.len() / 2],
            planes[planes.len() - 1]
        );
    }
}
