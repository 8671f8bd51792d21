//! One step of the tracker beside parry3d-f64 on the same poses, and beside the floor: the planes it cannot avoid.
//!
//! `contact`, `separated`: parts of about 100 mm slide 1 mm deep or 5 mm apart, 0.1 mm and a milliradian a step, the
//! latter about an axis drawn anew each time. At 1 kHz that is 0.1 m/s and 1 rad/s, about twice what a hand at work
//! does; with 20,000 faces a C-face measures 1 to 2 mm, so that every tenth step or so ends on another one.
//! `hand`: the same depth at several paces, and the axis wanders slowly, as a hand's does.

#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cspace::{Polyhedron, Tracker};
use parry3d_f64::math::Pose as ParryPose;
use spatial::{DVec3, Pose};
use std::hint::black_box;
use support::motions::{sliding, sliding_by_hand};
use support::*;

/// Seconds a step.
const TICK: f64 = 1e-3;

/// What a step cannot do without: the pose's matrix, one vertex, and the planes of one face and of a vertex ring.
struct Floor<'a> {
    a: &'a Polyhedron,
    b: &'a Polyhedron,
    planes: Vec<(DVec3, f64)>,
}

impl<'a> Floor<'a> {
    fn new(a: &'a Polyhedron, b: &'a Polyhedron) -> Self {
        let planes = b.faces().take(6).map(|f| (b.face_plane(f).normal, b.face_plane(f).distance)).collect();
        Self { a, b, planes }
    }

    fn step(&self, pose: &Pose) -> f64 {
        let r = pose.rotation_matrix();
        let p = pose.translation + r * self.a.vertices()[0];
        let q = r.transpose() * (self.b.vertices()[0] - pose.translation);
        self.planes.iter().map(|(n, d)| (n.dot(p) - d).max(n.dot(q))).fold(f64::NEG_INFINITY, f64::max)
    }
}

fn bodies() -> Vec<(&'static str, Mesh, Mesh)> {
    vec![
        ("tetrahedron-box", tetrahedron(0.04), cuboid(DVec3::splat(0.1))),
        ("box-box", cuboid(DVec3::new(0.06, 0.08, 0.1)), cuboid(DVec3::new(0.1, 0.09, 0.12))),
        ("36-faces", ball(36, 0.05), ball(36, 0.06)),
        ("200-faces", ball(200, 0.05), ball(200, 0.06)),
        ("2000-faces", ball(2000, 0.05), ball(2000, 0.06)),
        ("20000-faces", ball(20_000, 0.05), ball(20_000, 0.06)),
    ]
}

fn step(c: &mut Criterion) {
    for (label, gap) in [("contact", -0.001), ("separated", 0.005)] {
        let mut group = c.benchmark_group(label);
        for (name, a, b) in bodies() {
            let poses = sliding(&a, &b, gap, 2000);
            let (pa, pb) = (polyhedron(&a), polyhedron(&b));
            let mut tracker = Tracker::new(pa.clone(), pb.clone());
            tracker.seed(&poses[0]);
            // Forth and back, so that every step is a small one.
            let mut walk = poses.iter().chain(poses.iter().rev()).cycle();
            group.sample_size(20);
            group.bench_function(BenchmarkId::new("cspace", name), |bench| {
                bench.iter(|| tracker.step(black_box(walk.next().expect("endless"))));
            });
            let floor = Floor::new(&pa, &pb);
            group.bench_function(BenchmarkId::new("floor", name), |bench| {
                bench.iter(|| floor.step(black_box(walk.next().expect("endless"))));
            });
            let (sa, sb) = (parry_shape(&a), parry_shape(&b));
            group.sample_size(10);
            group.bench_function(BenchmarkId::new("parry3d-f64", name), |bench| {
                bench.iter(|| {
                    let pose = parry_pose(walk.next().expect("endless"));
                    parry3d_f64::query::contact(black_box(&pose), &sa, &ParryPose::IDENTITY, &sb, 0.02)
                });
            });
        }
        group.finish();
    }
}

/// Steps of a hand at 1 kHz, slow, as it works, and fast.
fn hand(c: &mut Criterion) {
    for (label, speed, spin) in
        [("10 mm_s 0.1 rad_s", 0.01, 0.1), ("50 mm_s 0.5 rad_s", 0.05, 0.5), ("0.5 m_s 5 rad_s", 0.5, 5.0)]
    {
        let mut group = c.benchmark_group(format!("hand at {label}"));
        group.sample_size(20);
        for (name, a, b) in bodies() {
            let poses = sliding_by_hand(&a, &b, -0.001, 2000, speed * TICK, spin * TICK);
            let mut tracker = Tracker::new(polyhedron(&a), polyhedron(&b));
            let mut walk = poses.iter().chain(poses.iter().rev()).cycle();
            group.bench_function(BenchmarkId::new("cspace", name), |bench| {
                bench.iter(|| tracker.step(black_box(walk.next().expect("endless"))));
            });
        }
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(500));
    targets = step, hand
}
criterion_main!(benches);
