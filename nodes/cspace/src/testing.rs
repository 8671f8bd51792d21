//! Bodies and poses for the unit tests.

use crate::audit::AuditScratch;
use crate::pair_state::PairState;
use crate::placed::At;
use crate::{BasicContact, Body, Polyhedron};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use spatial::{DQuat, DVec3, Pose};

/// A prism of a regular polygon with its axis along z.
fn prism(sides: u32, radius: f64, height: f64) -> Polyhedron {
    let at = |i: u32, z: f64| {
        let t = std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(sides);
        DVec3::new(radius * t.cos(), radius * t.sin(), z)
    };
    let v: Vec<DVec3> = [-0.5, 0.5].iter().flat_map(|k| (0..sides).map(move |i| at(i, k * height))).collect();
    let mut f: Vec<Vec<u32>> = (0..sides)
        .map(|i| {
            let j = (i + 1) % sides;
            vec![i, j, sides + j, sides + i]
        })
        .collect();
    f.push((0..sides).rev().collect());
    f.push((sides..2 * sides).collect());
    Polyhedron::from_faces(&v, &f).expect("a prism is a polyhedron")
}

/// A moving and a fixed body, some centimetres large.
pub(crate) fn some_bodies(rng: &mut Pcg64Mcg) -> [Body; 2] {
    [true, false].map(|moving| {
        let (radius, height) = (rng.random_range(0.01..0.03), rng.random_range(0.005..0.05));
        Body::new(&prism([3, 4, 4, 7][rng.random_range(0..4)], radius, height), moving)
    })
}

pub(crate) fn unit(rng: &mut Pcg64Mcg) -> DVec3 {
    loop {
        let v = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
        if v.length_squared() > 0.01 && v.length_squared() < 1.0 {
            return v.normalize();
        }
    }
}

/// A turn, and often one that leaves the bodies nearly aligned.
pub(crate) fn some_turn(rng: &mut Pcg64Mcg) -> DQuat {
    let quarters = DQuat::from_axis_angle(DVec3::X, f64::from(rng.random_range(0..2)) * std::f64::consts::FRAC_PI_2);
    let angle = if rng.random_range(0..2) == 0 { 3.0 } else { 10.0_f64.powf(rng.random_range(-4.0..-1.0)) };
    (DQuat::from_axis_angle(unit(rng), rng.random_range(-angle..angle)) * quarters).normalize()
}

/// The C-obstacle's support function about `x`, metres, by looking at all vertices.
pub(crate) fn support([a, b]: &[Body; 2], pose: &Pose, m: DVec3) -> f64 {
    let farthest = b.points.iter().map(|p| m.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
    let nearest = a.points.iter().map(|p| m.dot(pose.transform_point(*p))).fold(f64::INFINITY, f64::min);
    farthest - nearest
}

/// A pose at some depth, and Near there: in from outside along a line, so that it is on the side by which A came.
pub(crate) fn some_contact(rng: &mut Pcg64Mcg, [a, b]: &[Body; 2]) -> Option<(Pose, BasicContact)> {
    let (rotation, out) = (some_turn(rng), unit(rng));
    let depth = 10.0_f64.powf(rng.random_range(-5.0..-2.2));
    let (mut state, mut scratch) = (PairState::NEW, AuditScratch::new());
    let mut pose = Pose::new(out * 0.2, rotation);
    for _ in 0..200 {
        let tracked = state.step(a, b, &mut scratch, &At::new(a, &pose));
        let further = tracked.distance + depth;
        if further < 1e-9 {
            return (!tracked.divergent).then_some((pose, tracked.near.contact));
        }
        pose.translation -= out * (0.5 * further).clamp(1e-6, 1e-3);
    }
    None
}
