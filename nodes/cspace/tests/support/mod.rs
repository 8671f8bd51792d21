//! Shapes, motions and independent oracles for tests, benches and examples.
#![allow(dead_code, missing_docs)]

pub mod judge;
pub mod motions;

use cspace::Polyhedron;
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::shape::ConvexPolyhedron;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use spatial::{DQuat, DVec3, Pose};
use std::sync::Arc;

pub type Random = Pcg64Mcg;

pub fn random(seed: u64) -> Random {
    Random::seed_from_u64(seed)
}

pub fn unit(rng: &mut Random) -> DVec3 {
    loop {
        let v = DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
        if v.length_squared() > 0.01 && v.length_squared() < 1.0 {
            return v.normalize();
        }
    }
}

pub fn rotation(rng: &mut Random) -> DQuat {
    DQuat::from_axis_angle(unit(rng), rng.random_range(-3.0..3.0)).normalize()
}

/// Vertices and polygon faces.
pub type Mesh = (Vec<DVec3>, Vec<Vec<u32>>);

pub fn cuboid(size: DVec3) -> Mesh {
    let v = (0..8)
        .map(|i| size * (DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) - 0.5))
        .collect();
    let f = vec![
        vec![0, 2, 3, 1],
        vec![4, 5, 7, 6],
        vec![0, 1, 5, 4],
        vec![2, 6, 7, 3],
        vec![0, 4, 6, 2],
        vec![1, 3, 7, 5],
    ];
    (v, f)
}

pub fn prism(sides: u32, radius: f64, height: f64) -> Mesh {
    let at = |i: u32, z: f64| {
        let t = std::f64::consts::TAU * f64::from(i) / f64::from(sides);
        DVec3::new(radius * t.cos(), radius * t.sin(), z)
    };
    let v = (0..sides).map(|i| at(i, -0.5 * height)).chain((0..sides).map(|i| at(i, 0.5 * height))).collect();
    let mut f: Vec<Vec<u32>> = (0..sides)
        .map(|i| {
            let j = (i + 1) % sides;
            vec![i, j, sides + j, sides + i]
        })
        .collect();
    f.push((0..sides).rev().collect());
    f.push((sides..2 * sides).collect());
    (v, f)
}

pub fn tetrahedron(size: f64) -> Mesh {
    let v = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    (
        v.iter().map(|p| DVec3::from_array(*p) * size).collect(),
        vec![vec![0, 1, 2], vec![0, 3, 1], vec![0, 2, 3], vec![1, 3, 2]],
    )
}

/// The hull of random points on an ellipsoid.
pub fn hull(points: usize, size: DVec3, seed: u64) -> Mesh {
    let mut rng = random(seed);
    let cloud: Vec<DVec3> = (0..points).map(|_| unit(&mut rng) * size).collect();
    let (v, f) = parry3d_f64::transformation::convex_hull(&cloud);
    (v, f.into_iter().map(|t| t.to_vec()).collect())
}

/// A nearly uniform ball of about `faces` triangles (spiral points).
pub fn ball(faces: usize, radius: f64) -> Mesh {
    let n = faces / 2 + 2;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let cloud: Vec<DVec3> = (0..n)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64;
            let (s, c) = (golden * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * c, r * s, z) * radius
        })
        .collect();
    let (v, f) = parry3d_f64::transformation::convex_hull(&cloud);
    (v, f.into_iter().map(|t| t.to_vec()).collect())
}

pub fn scaled((v, f): Mesh, s: f64) -> Mesh {
    (v.into_iter().map(|p| p * s).collect(), f)
}

pub fn polyhedron(mesh: &Mesh) -> Arc<Polyhedron> {
    Arc::new(Polyhedron::from_faces(&mesh.0, &mesh.1).expect("test shape"))
}

/// The same body for parry.
pub fn parry_shape(mesh: &Mesh) -> ConvexPolyhedron {
    let triangles: Vec<[u32; 3]> =
        mesh.1.iter().flat_map(|f| (1..f.len() - 1).map(|i| [f[0], f[i], f[i + 1]])).collect();
    ConvexPolyhedron::from_convex_mesh(mesh.0.clone(), &triangles)
        .unwrap_or_else(|| ConvexPolyhedron::from_convex_hull(&mesh.0).expect("parry shape"))
}

pub fn parry_pose(p: &Pose) -> ParryPose {
    ParryPose::from_parts(p.translation, p.rotation)
}

/// Signed distance by parry: `< 0` is the penetration depth; none beyond `margin`.
pub fn parry_distance(a: &ConvexPolyhedron, b: &ConvexPolyhedron, pose: &Pose, margin: f64) -> Option<f64> {
    parry3d_f64::query::contact(&parry_pose(pose), a, &ParryPose::IDENTITY, b, margin)
        .expect("supported")
        .map(|c| c.dist)
}

/// The largest signed distance of `x` over all planes of the C-obstacle, by every applicable basic contact, each
/// verified against all vertices: the hull's facets of `{b - R a}`.
pub fn exhaustive_distance(a: &Polyhedron, b: &Polyhedron, pose: &Pose) -> f64 {
    cspace::applicable_c_faces(a, b, pose).iter().map(|f| f.distance).fold(f64::NEG_INFINITY, f64::max)
}

/// `max_n min_v` over the given direction: the signed distance of `x` to the C-obstacle's supporting plane along `n`.
pub fn plane_distance(a: &Polyhedron, b: &Polyhedron, pose: &Pose, n: DVec3) -> f64 {
    let hb = b.corner_ids().map(|v| n.dot(b.vertex(v))).fold(f64::NEG_INFINITY, f64::max);
    let ha = a.corner_ids().map(|v| n.dot(pose.transform_point(a.vertex(v)))).fold(f64::INFINITY, f64::min);
    ha - hb
}
