//! What steps cost while sliding in shallow contact: planes looked at and CPU time, without criterion's machinery.

#[path = "../tests/support/mod.rs"]
mod support;

use cspace::Tracker;
use spatial::DVec3;
use std::time::Instant;
use support::motions::sliding;
use support::*;

fn main() {
    let gap = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(-0.001);
    let balls = [36, 200, 2000, 20_000].map(|n| (n, ball(n, 0.05), ball(n, 0.06)));
    let boxes = [
        (4, tetrahedron(0.04), cuboid(DVec3::splat(0.1))),
        (6, cuboid(DVec3::new(0.06, 0.08, 0.1)), cuboid(DVec3::new(0.1, 0.09, 0.12))),
    ];
    for (faces, a, b) in boxes.into_iter().chain(balls) {
        let poses = sliding(&a, &b, gap, 4000);
        let fresh = Tracker::new(polyhedron(&a), polyhedron(&b));
        let mut best = f64::INFINITY;
        for _ in 0..7 {
            let mut tracker = fresh.clone();
            let start = Instant::now();
            for pose in &poses {
                std::hint::black_box(tracker.step(std::hint::black_box(pose)));
            }
            best = best.min(start.elapsed().as_nanos() as f64 / poses.len() as f64);
        }
        let mut tracker = fresh.clone();
        let mut planes: Vec<u32> = poses.iter().map(|p| tracker.step(p).planes).collect();
        planes.sort_unstable();
        let mean = planes.iter().map(|p| f64::from(*p)).sum::<f64>() / planes.len() as f64;
        let audits = planes.iter().filter(|p| **p > 15).count();
        println!(
            "{faces:>6} faces: {best:7.1} ns a step, planes mean {mean:.1} median {} max {}, {audits} long steps",
            planes[planes.len() / 2],
            planes[planes.len() - 1]
        );
    }
}
