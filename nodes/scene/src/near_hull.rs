//! Meshes that are their own convex hull but for the digits of their vertices.

use crate::Mesh;
use crate::hull::hull;
use crate::mesh::position_bits;
use cspace::{Plane, Polyhedron};
use spatial::DVec3;
use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

/// Corners this close to their opposite sides, as a part of what the digits leave open, make slivers and no faces.
const THIN: f64 = 0.1;
/// Times that such corners are left out; without the last ones' neighbours others may become such.
const ROUNDS: usize = 16;

/// The hull of the mesh if no place of its surface lies more than `tolerance` metres below it: over the mesh's own vertices, its
/// triangles in the order of the facets that they lie in. `None` if there is such a place, or this is not one closed surface.
pub fn near_hull(mesh: &Mesh, tolerance: f64) -> Option<Mesh> {
    let welded = mesh.welded();
    let sides = welded.face_at_sides();
    let is_closed = sides.keys().all(|&(a, b)| sides.contains_key(&(b, a)));
    // Two bodies that touch share sides.
    let is_simple = sides.len() == welded.faces.iter().map(Vec::len).sum::<usize>();
    if !is_closed || !is_simple || welded.components().len() != 1 {
        return None;
    }
    let hull = hull_without_slivers(&welded.vertices, THIN * tolerance)?;
    let body = Polyhedron::from_faces(&hull.vertices, &hull.faces).ok()?;
    // A body lies in the ball about its bounding box, and the hull is no larger than that ball's surface.
    let lost = hull.volume() - welded.volume();
    if !(lost <= tolerance * PI * welded.size().powi(2)) {
        return None;
    }
    let is_deep = |p: DVec3| body.contains(p, -tolerance);
    let at = |v: u32| welded.vertices[v as usize];
    let valleys = sides.iter().filter(|&(&(a, b), &facet)| {
        a < b && {
            let across = sides[&(b, a)];
            rises(&welded, facet, across) || rises(&welded, across, facet)
        }
    });
    if valleys.map(|(&(a, b), _)| at(a).midpoint(at(b))).any(is_deep) || welded.vertices.iter().any(|v| is_deep(*v)) {
        return None;
    }
    let (in_welded, in_mesh) = (indices(&welded.vertices), indices(&mesh.vertices));
    let triangle = |face: &Vec<u32>| {
        let corners: Vec<DVec3> = face.iter().map(|&v| hull.vertices[v as usize]).collect();
        let [of_welded, of_mesh] =
            [&in_welded, &in_mesh].map(|of| corners.iter().map(|v| of[&position_bits(*v)]).collect::<Vec<u32>>());
        let along = (0..3).filter_map(|i| sides.get(&(of_welded[i], of_welded[(i + 1) % 3])));
        (along.copied().min().unwrap_or(usize::MAX), of_mesh)
    };
    let mut faces: Vec<(usize, Vec<u32>)> = hull.faces.iter().map(triangle).collect();
    faces.sort_by_key(|(facet, _)| *facet);
    Some(Mesh { vertices: mesh.vertices.clone(), faces: faces.into_iter().map(|(_, face)| face).collect() })
}

/// The hull of the points without those that lie between two others of it: less than `height` off their line, metres.
fn hull_without_slivers(points: &[DVec3], height: f64) -> Option<Mesh> {
    let mut points = points.to_vec();
    for _ in 0..ROUNDS {
        let hull = hull(&points).ok()?;
        let between: HashSet<_> = hull.triangles().filter_map(|t| middle(t, height)).map(position_bits).collect();
        if between.is_empty() {
            return Some(hull);
        }
        points.retain(|p| !between.contains(&position_bits(*p)));
    }
    None
}

/// The corner of a triangle across its longest side, if it lies less than `height` off that, metres.
fn middle([a, b, c]: [DVec3; 3], height: f64) -> Option<DVec3> {
    let across = [(b.distance(c), a), (c.distance(a), b), (a.distance(b), c)];
    let (longest, corner) = across.into_iter().max_by(|(l, _), (m, _)| l.total_cmp(m))?;
    ((b - a).cross(c - a).length() <= height * longest).then_some(corner)
}

/// Whether some corner of facet `other` lies above the plane of `facet`.
fn rises(mesh: &Mesh, facet: usize, other: usize) -> bool {
    let corners = |f: usize| mesh.faces[f].iter().map(|&v| mesh.vertices[v as usize]);
    let [a, b, c] = [0, 1, 2].map(|i| mesh.vertices[mesh.faces[facet][i] as usize]);
    let Some(normal) = (b - a).cross(c - a).try_normalize() else { return true };
    let plane = Plane { normal, distance: normal.dot(a) };
    corners(other).any(|p| plane.signed_distance(p) > 0.0)
}

/// Where each position is first in the list.
fn indices(vertices: &[DVec3]) -> HashMap<[u64; 3], u32> {
    let mut index_at = HashMap::with_capacity(vertices.len());
    for (i, v) in vertices.iter().enumerate() {
        index_at.entry(position_bits(*v)).or_insert(i as u32);
    }
    index_at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flat::{polyhedron, straightened};
    use spatial::DQuat;

    fn turn() -> DQuat {
        DQuat::from_rotation_z(0.7) * DQuat::from_rotation_x(1.1) * DQuat::from_rotation_y(0.4)
    }

    fn written(mesh: &Mesh, decimals: usize) -> Mesh {
        let write = |x: f64| format!("{x:.decimals$}").parse().unwrap();
        Mesh { vertices: mesh.vertices.iter().map(|v| DVec3::from(v.to_array().map(write))).collect(), ..mesh.clone() }
    }

    /// Meridians and parallels; the quadrangles between them, which are plane, cut into triangles.
    fn ball(meridians: u32, parallels: u32) -> Mesh {
        let mut mesh = Mesh { vertices: vec![DVec3::Z], faces: Vec::new() };
        for i in 1..parallels {
            for j in 0..meridians {
                let (down, around) =
                    (PI * f64::from(i) / f64::from(parallels), 2.0 * PI * f64::from(j) / f64::from(meridians));
                mesh.vertices.push(DVec3::new(down.sin() * around.cos(), down.sin() * around.sin(), down.cos()));
            }
        }
        mesh.vertices.push(-DVec3::Z);
        let (at, last) = (|i: u32, j: u32| 1 + (i - 1) * meridians + j % meridians, mesh.vertices.len() as u32 - 1);
        for j in 0..meridians {
            mesh.faces.push(vec![0, at(1, j), at(1, j + 1)]);
            for i in 1..parallels - 1 {
                mesh.faces.push(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                mesh.faces.push(vec![at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
            mesh.faces.push(vec![last, at(parallels - 1, j + 1), at(parallels - 1, j)]);
        }
        mesh.vertices.iter_mut().for_each(|v| *v = turn() * (0.05 * *v));
        mesh
    }

    /// A box of half sides `half`, its edges and corners rounded with `radius` in `steps` a quarter, as triangles.
    fn rounded_box(half: DVec3, radius: f64, steps: u32) -> Mesh {
        let inner = half - DVec3::splat(radius);
        let angle = |i: u32| 0.5 * PI * f64::from(i) / f64::from(steps);
        let mut points = Vec::new();
        for corner in 0..8 {
            let sign = |axis: u32| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
            let outward = DVec3::new(sign(0), sign(1), sign(2));
            points.push(outward * (inner + DVec3::Z * radius));
            for (i, j) in (0..steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
                let (up, around) = (angle(i), angle(j));
                let round = DVec3::new(up.cos() * around.cos(), up.cos() * around.sin(), up.sin());
                points.push(outward * (inner + round * radius));
            }
        }
        let mut mesh = hull(&points).unwrap();
        mesh.vertices.iter_mut().for_each(|v| *v = turn() * *v);
        mesh
    }

    fn refused(mesh: &Mesh) -> bool {
        Polyhedron::from_faces(&mesh.vertices, &mesh.faces).is_err()
    }

    /// Steps of the last digit that a vertex of the file lies below the surface, at most.
    fn deepest(mesh: &Mesh, body: &Polyhedron, step: f64) -> f64 {
        let depth =
            |v: &DVec3| body.faces().map(|f| -body.face_plane(f).signed_distance(*v)).fold(f64::INFINITY, f64::min);
        mesh.vertices.iter().map(depth).fold(0.0, f64::max) / step
    }

    #[test]
    fn round_parts_whose_facets_lean_as_the_digits_say_are_taken_as_convex() {
        for (part, decimals) in [(ball(64, 32), 6), (ball(100, 50), 7), (ball(40, 80), 6)] {
            let file = written(&part, decimals as usize);
            assert!(refused(&file), "convex as it stands: the test shows nothing");
            let body = polyhedron(&file).unwrap();
            assert_eq!(body.vertices().len(), file.vertices.len());
            assert!(deepest(&file, &body, 10f64.powi(-decimals)) < 4.0);
            // The file's first facets are at the pole.
            assert!(body.face_vertices(cspace::FaceId(0)).contains(&cspace::VertexId(0)));
        }
    }

    #[test]
    fn large_faces_of_parts_with_fine_fillets_are_plane() {
        let part = rounded_box(DVec3::new(0.02, 0.03, 0.01), 1e-3, 8);
        for decimals in [6, 7] {
            let file = written(&part, decimals);
            assert!(refused(&file), "convex as it stands: the test shows nothing");
            let body = polyhedron(&straightened(file)).unwrap();
            let flat = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]).filter(|axis| {
                let normal = turn() * *axis;
                // One face with all corners of its rectangle.
                body.faces()
                    .any(|f| body.face_plane(f).normal.dot(normal) > 1.0 - 1e-7 && body.face_vertices(f).len() >= 4)
            });
            assert_eq!(flat.count(), 6, "{decimals} decimals");
        }
    }

    #[test]
    fn valleys_and_several_bodies_are_no_hulls() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        // The lid is cut along the diagonal of its lower corners: all vertices are the hull's own.
        let mut valley = hull(
            &[0.0, 0.01].map(|z| [at(0.0, 0.0, z), at(0.05, 0.0, z), at(0.05, 0.04, z), at(0.0, 0.04, z)]).concat(),
        )
        .unwrap();
        let raised = |v: &DVec3| v.z > 0.0 && (v.x > 0.0) == (v.y > 0.0);
        valley.vertices.iter_mut().for_each(|v| {
            if raised(v) {
                v.z += 1e-4
            }
        });
        let index = |v: DVec3| valley.vertices.iter().position(|w| *w == v).unwrap() as u32;
        let [a, b, c, d] =
            [at(0.0, 0.0, 0.0101), at(0.05, 0.0, 0.01), at(0.05, 0.04, 0.0101), at(0.0, 0.04, 0.01)].map(index);
        valley.faces.retain(|face| face.iter().any(|&v| valley.vertices[v as usize].z == 0.0));
        valley.faces.extend([vec![a, b, d], vec![b, c, d]]);
        assert!(near_hull(&valley, 1e-5).is_none());
        assert!(near_hull(&valley, 1e-3).is_some());
        // Two boxes, one on the other.
        let brick = |z: f64| {
            hull(
                &[z, z + 0.01]
                    .map(|z| [at(0.0, 0.0, z), at(0.05, 0.0, z), at(0.05, 0.04, z), at(0.0, 0.04, z)])
                    .concat(),
            )
            .unwrap()
        };
        let mut pile = brick(0.0);
        pile.append(&brick(0.01));
        assert!(near_hull(&pile, 1e-6).is_none());
        assert!(near_hull(&brick(0.0), 1e-6).is_some());
    }
}
