//! Bodies and worlds for the law tests.
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod random;
#[path = "../../src/testing.rs"]
mod testing;

use cspace::{FixedPart, Polyhedron, World};
use spatial::{DVec3, Pose};
use std::sync::Arc;
pub use testing::cuboid;

/// Millimetres to metres.
pub fn mm(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z) * 1e-3
}

/// A box of the given size (metres) about the origin.
pub fn block(size: DVec3) -> Polyhedron {
    cuboid(-0.5 * size, 0.5 * size)
}

/// A wedge: edge along y at the origin, opening downwards by `2 half_angle`, `depth` high, `width` long.
pub fn wedge(half_angle: f64, depth: f64, width: f64) -> Polyhedron {
    let x = depth * half_angle.tan();
    let y = 0.5 * width;
    let v = [
        DVec3::new(0.0, -y, 0.0),
        DVec3::new(0.0, y, 0.0),
        DVec3::new(-x, -y, -depth),
        DVec3::new(x, -y, -depth),
        DVec3::new(-x, y, -depth),
        DVec3::new(x, y, -depth),
    ];
    let faces = vec![vec![0, 2, 3], vec![1, 5, 4], vec![0, 1, 4, 2], vec![0, 3, 5, 1], vec![2, 4, 5, 3]];
    Polyhedron::from_faces(&v, &faces).expect("a wedge is a polyhedron")
}

/// A regular tetrahedron of the given edge about its centroid.
pub fn tetrahedron(edge: f64) -> Polyhedron {
    let s = edge / 8f64.sqrt();
    let v = [
        DVec3::new(1.0, 1.0, 1.0) * s,
        DVec3::new(1.0, -1.0, -1.0) * s,
        DVec3::new(-1.0, 1.0, -1.0) * s,
        DVec3::new(-1.0, -1.0, 1.0) * s,
    ];
    let faces = vec![vec![0, 1, 2], vec![0, 2, 3], vec![0, 3, 1], vec![1, 3, 2]];
    Polyhedron::from_faces(&v, &faces).expect("a tetrahedron is a polyhedron")
}

/// One moving body against pieces, each an obstacle of its own.
pub fn world(moving: Polyhedron, fixed: Vec<Polyhedron>) -> Arc<World> {
    let fixed =
        fixed.into_iter().zip(0..).map(|(p, obstacle)| FixedPart { polyhedron: Arc::new(p), obstacle }).collect();
    Arc::new(World { moving: vec![Arc::new(moving)], fixed })
}

/// The paper's peg in its hole: 16 x 10 in 16.25 x 10.21, 30 deep; mouth at z = 0 (mm).
pub fn peg_in_hole() -> Arc<World> {
    world(block(mm(16.0, 10.0, 40.0)), hole())
}

/// The plate with the hole, of five pieces.
pub fn hole() -> Vec<Polyhedron> {
    let (x, y) = (16.25 / 2.0, 10.21 / 2.0);
    let out = 30.0;
    vec![
        cuboid(mm(x, -out, -40.0), mm(out, out, 0.0)),
        cuboid(mm(-out, -out, -40.0), mm(-x, out, 0.0)),
        cuboid(mm(-x, y, -40.0), mm(x, out, 0.0)),
        cuboid(mm(-x, -out, -40.0), mm(x, -y, 0.0)),
        cuboid(mm(-x, -y, -40.0), mm(x, y, -30.0)),
    ]
}

pub fn pose(x: f64, y: f64, z: f64, rx: f64, ry: f64, rz: f64) -> Pose {
    Pose::from_xyz_rpy(mm(x, y, z), DVec3::new(rx, ry, rz))
}

/// The depth of two convex bodies by all separating axes, metres: faces of both, and pairs of edges. `< 0` if apart.
fn depth_by_axes(a: &Polyhedron, b: &Polyhedron, pose: &Pose) -> f64 {
    let placed: Vec<DVec3> = a.vertices().iter().map(|v| pose.transform_point(*v)).collect();
    let edges_b: Vec<DVec3> = b.edges().map(|e| b.edge_direction(e)).collect();
    let across = a.edges().flat_map(|e| {
        let u = pose.rotation * a.edge_direction(e);
        edges_b.iter().filter_map(move |v| u.cross(*v).try_normalize())
    });
    let faces =
        a.faces().map(|f| pose.rotation * a.face_plane(f).normal).chain(b.faces().map(|f| b.face_plane(f).normal));
    let overlap = |n: DVec3| {
        let high = |points: &[DVec3], n: DVec3| points.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max);
        let along = |n: DVec3| high(&placed, n) + high(b.vertices(), -n);
        along(n).min(along(-n))
    };
    faces.chain(across).map(overlap).fold(f64::INFINITY, f64::min)
}

/// The deepest penetration of the posed body in any piece, metres, by parry: the independent oracle. Where bodies lie
/// flush parry now and then reports millimetres: what it finds must hold along every separating axis, too.
pub fn penetration(world: &World, pose: &Pose) -> f64 {
    let mut worst = f64::NEG_INFINITY;
    for a in &world.moving {
        let placed: Vec<_> = a.vertices().iter().map(|v| pose.transform_point(*v)).collect();
        let sa = parry3d_f64::shape::ConvexPolyhedron::from_convex_hull(&placed).expect("convex");
        for b in &world.fixed {
            let sb = parry3d_f64::shape::ConvexPolyhedron::from_convex_hull(b.polyhedron.vertices()).expect("convex");
            let id = parry3d_f64::math::Pose::IDENTITY;
            if let Ok(Some(c)) = parry3d_f64::query::contact(&id, &sa, &id, &sb, 1.0) {
                worst = worst.max((-c.dist).min(depth_by_axes(a, &b.polyhedron, pose)));
            }
        }
    }
    worst
}
