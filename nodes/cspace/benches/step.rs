//! One step of the tracker beside parry3d-f64 on the same poses, and beside the floor: the planes it cannot avoid.

#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cspace::{Polyhedron, Tracker};
use parry3d_f64::math::Pose as ParryPose;
use spatial::{DVec3, Pose};
use std::hint::black_box;
use support::motions::sliding;
use support::*;

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

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(500));
    targets = step
}
criterion_main!(benches);
