//! A whole tick of a body against many obstacle pieces: 10, 100, 1,000 near ones, and 100,000 far ones added.

#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cspace::{BodyTracker, FixedPart, World};
use spatial::{DQuat, DVec3, Pose};
use std::hint::black_box;
use std::sync::Arc;
use support::*;

/// A flat box over a floor of `near` tiles under it, and `far` tiles around.
fn world(near: usize, far: usize) -> Arc<World> {
    let side = (near as f64).sqrt().ceil() as usize;
    let piece = |center: DVec3, size: f64, i: usize| FixedPart {
        polyhedron: Arc::new(
            polyhedron(&cuboid(DVec3::new(size, size, 0.02))).transformed(&Pose::new(center, DQuat::IDENTITY), 1.0),
        ),
        obstacle: i as u32,
    };
    let at = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 - 0.5;
    let tile = 0.4 / side as f64;
    let mut fixed: Vec<FixedPart> = (0..near)
        .map(|i| piece(DVec3::new(0.4 * at(i % side, side), 0.4 * at(i / side, side), -0.01), tile, i))
        .collect();
    let wide = (far as f64).sqrt().ceil().max(1.0) as usize;
    fixed.extend((0..far).map(|i| {
        piece(DVec3::new(12.0 + 20.0 * at(i % wide, wide), 20.0 * at(i / wide, wide), -0.01), 0.05, near + i)
    }));
    Arc::new(World { moving: vec![polyhedron(&cuboid(DVec3::new(0.44, 0.44, 0.03)))], fixed })
}

fn many_pairs(c: &mut Criterion) {
    let mut group = c.benchmark_group("tick");
    group.sample_size(20);
    for (near, far) in [(10, 0), (100, 0), (1000, 0), (1000, 100_000)] {
        let mut tracker = BodyTracker::new(world(near, far), 0.01);
        let mut k = 0u32;
        let mut pose = || {
            k += 1;
            let t = f64::from(k) * 0.001;
            let turn = DVec3::new(0.002 * (3.0 * t).sin(), 0.002 * (2.0 * t).cos(), 0.05 * t.sin());
            Pose::new(DVec3::new(0.01 * t.sin(), 0.01 * (1.3 * t).cos(), 0.0148), DQuat::from_scaled_axis(turn))
        };
        tracker.step(&pose());
        println!("near {near}: {} pairs within the margin", tracker.active().len());
        group.bench_function(BenchmarkId::new(format!("{near} near"), far), |bench| {
            bench.iter(|| tracker.step(black_box(&pose())).len());
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(500))
        .measurement_time(std::time::Duration::from_secs(2));
    targets = many_pairs
}
criterion_main!(benches);
