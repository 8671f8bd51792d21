//! Faces that the digits of a file have bent: a face's triangles, written with six digits, lie in one plane no longer.

use crate::Mesh;
use crate::digits::left_open;
use crate::mesh::position_bits;
use crate::near_hull::near_hull;
use cspace::{Plane, Polyhedron, PolyhedronError};
use nalgebra::{DVector, MatrixXx3};
use spatial::DVec3;
use std::collections::HashMap;

/// Facets as flat as this, of the size, are one face however many digits there are: so much is left of CAD's own arithmetic.
const LEAST: f64 = 1e-8;
/// The most that digits may leave open, of the size: where a surface is dented, and where it is convex as it stands.
const MOST: f64 = 1e-4;
const MOST_OF_CONVEX: f64 = 1e-6;
/// Faces whose sides are longer than this many times what the digits leave open are large.
const LARGE: f64 = 1e3;
/// A vertex where planes meet is moved no farther than this many times as far as it may lie off one.
const REACH: f64 = 3.0;
/// Planes that lean less than this, radians, ask for nothing in the direction that only their difference asks for.
const PARALLEL: f64 = 3e-5;
/// Planes meet in a point that lies off none by more than this part of how far it may be moved.
const EXACT: f64 = 1e-9;

/// The polyhedron of a mesh. Where it is not convex as it stands, its faces are made plane as far as the digits of the
/// coordinates leave that open, without the slivers that they have made lines of; where facets are so small that the digits
/// decide how they lean, it is the hull. Vertices and faces count as in the mesh.
///
/// # Errors
/// The mesh is not convex, however the digits are read.
pub fn polyhedron(mesh: &Mesh) -> Result<Polyhedron, PolyhedronError> {
    whole(mesh).or_else(|refused| {
        let sound = mesh.without_collapsed_faces();
        whole(&sound).or_else(|_| convex_for_its_digits(&sound).and_then(|m| whole(&m).ok()).ok_or(refused))
    })
}

/// The mesh with faces made plane where the digits of its coordinates have bent them: dented ones would be cut into slivers,
/// and of bulging ones contact would know only a facet at a time.
#[must_use]
pub fn straightened(mesh: Mesh) -> Mesh {
    let faces = |m: &Mesh| whole(m).map(|p| p.face_count());
    let flat = match faces(&mesh) {
        Err(_) => convex_for_its_digits(&mesh)
            .or_else(|| convex_bodies_for_their_digits(&mesh))
            .or_else(|| flattened(&mesh, tolerance(&mesh, MOST), 0.0)),
        Ok(count) => {
            flattened(&mesh, tolerance(&mesh, MOST_OF_CONVEX), 0.0).filter(|m| faces(m).is_ok_and(|flat| flat < count))
        }
    };
    flat.unwrap_or(mesh)
}

/// The same of a mesh of several bodies, if all are convex for their digits and one at least was not as it stood.
fn convex_bodies_for_their_digits(mesh: &Mesh) -> Option<Mesh> {
    let bodies = mesh.components();
    if bodies.len() < 2 || bodies.iter().all(|body| whole(body).is_ok()) {
        return None;
    }
    let mut all = Mesh::default();
    for body in bodies {
        let convex = if whole(&body).is_ok() { Some(body) } else { convex_for_its_digits(&body) };
        all.append(&convex?);
    }
    Some(all)
}

fn whole(mesh: &Mesh) -> Result<Polyhedron, PolyhedronError> {
    Polyhedron::from_faces(&mesh.vertices, &mesh.faces)
}

/// The mesh made convex as far as its digits leave that open: with plane faces, or as the hull of what that gives.
fn convex_for_its_digits(mesh: &Mesh) -> Option<Mesh> {
    let open = tolerance(mesh, MOST);
    let flat = flattened(mesh, open, 0.0);
    if let Some(flat) = flat.as_ref().filter(|flat| whole(flat).is_ok()) {
        return Some(flat.clone());
    }
    // Where facets are so small that many lie in one plane by chance, only large faces are made plane, or none.
    let large = flattened(mesh, open, LARGE * open);
    large
        .iter()
        .chain([mesh])
        .find_map(|m| near_hull(m, open).filter(|hull| whole(hull).is_ok_and(|body| is_near(mesh, &body, open))))
}

/// Whether all vertices of the mesh lie within `open` metres of the body's surface.
fn is_near(mesh: &Mesh, body: &Polyhedron, open: f64) -> bool {
    mesh.vertices.iter().all(|v| body.contains(*v, open) && !body.contains(*v, -open))
}

/// How far vertices may be moved, metres: `most` of the size at most.
fn tolerance(mesh: &Mesh, most: f64) -> f64 {
    let size = mesh.size();
    left_open(mesh).unwrap_or(0.0).clamp(LEAST * size, most * size)
}

/// The mesh with faces made plane that bend by no more than `tolerance`, metres, its vertices and faces in the same order; `None`
/// where that moves nothing. Faces smaller than a square with sides of `least`
/// are left as they are.
fn flattened(mesh: &Mesh, tolerance: f64, least: f64) -> Option<Mesh> {
    let welded = mesh.welded();
    let faces = Faces::of(&welded, tolerance, least)?;
    let mut bent = 0.0f64;
    let mut moved_from = HashMap::with_capacity(welded.vertices.len());
    for (vertex, planes) in welded.vertices.iter().zip(faces.through_vertices(&welded)) {
        let moved = moved_onto(*vertex, &planes, REACH * tolerance);
        bent = bent.max(moved.distance(*vertex));
        moved_from.insert(position_bits(*vertex), moved);
    }
    let vertices = mesh.vertices.iter().filter_map(|v| moved_from.get(&position_bits(*v)).copied()).collect();
    (bent > 1e-12 * mesh.size()).then(|| Mesh { vertices, faces: mesh.faces.clone() })
}

/// The point nearest to `p` that lies in all planes, or least far from them, if that is within `reach` metres; else in as many,
/// the largest faces' first, as meet there: planes that are nearly parallel meet far away.
fn moved_onto(p: DVec3, planes: &[Plane], reach: f64) -> DVec3 {
    let all = nearest_on_all(p, planes);
    if all.distance(p) <= reach {
        return all;
    }
    let (mut kept, mut at) = (Vec::with_capacity(planes.len()), p);
    for plane in planes {
        kept.push(*plane);
        let moved = nearest_on_all(p, &kept);
        let meet = kept.iter().all(|plane| plane.signed_distance(moved).abs() <= EXACT * reach);
        if meet && moved.distance(p) <= reach {
            at = moved;
        } else {
            kept.pop();
        }
    }
    at
}

/// Which facets of the file make one face, and its plane.
struct Faces {
    face_of: Vec<usize>,
    /// `None` for a triangle by itself, which is plane wherever its corners are, for what bends too much as a whole, and for
    /// small ones that are not wanted.
    planes: Vec<Option<Plane>>,
}

impl Faces {
    /// Grows faces from the largest facets on, as far as neighbours lie in the plane of what has grown. Those smaller than a
    /// square with sides of `least` are none.
    fn of(mesh: &Mesh, tolerance: f64, least: f64) -> Option<Self> {
        let area = |f: usize| vector_area(mesh, f);
        let neighbours = neighbours(mesh)?;
        let mut seeds: Vec<usize> = (0..mesh.faces.len()).collect();
        seeds.sort_by(|&f, &g| area(g).length_squared().total_cmp(&area(f).length_squared()));
        let mut face_of = vec![usize::MAX; mesh.faces.len()];
        let mut planes = Vec::new();
        for seed in seeds {
            if face_of[seed] != usize::MAX {
                continue;
            }
            let (mut members, mut sum) = (vec![seed], area(seed));
            face_of[seed] = planes.len();
            let mut ring = neighbours[seed].clone();
            while !ring.is_empty() {
                let plane = plane_of(mesh, &members, sum)?;
                let fits = |g: &usize| {
                    let flat = mesh.faces[*g]
                        .iter()
                        .all(|&v| plane.signed_distance(mesh.vertices[v as usize]).abs() <= tolerance);
                    flat && area(*g).dot(plane.normal) > 0.5 * area(*g).length()
                };
                let mut grown = Vec::new();
                for g in ring {
                    if face_of[g] == usize::MAX && fits(&g) {
                        face_of[g] = planes.len();
                        sum += area(g);
                        grown.push(g);
                    }
                }
                ring = grown.iter().flat_map(|&g| neighbours[g].iter().copied()).collect();
                members.extend(grown);
            }
            let plane = plane_of(mesh, &members, sum)?;
            let mut corners = members.iter().flat_map(|&f| &mesh.faces[f]);
            let is_plane = corners.all(|&v| plane.signed_distance(mesh.vertices[v as usize]).abs() <= tolerance);
            let is_large = sum.length() >= 2.0 * least * least;
            planes.push((is_plane && is_large && (members.len() > 1 || mesh.faces[seed].len() > 3)).then_some(plane));
        }
        Some(Self { face_of, planes })
    }

    /// For each vertex the planes that it has to lie in, in the order of the faces: from the largest on.
    fn through_vertices(&self, mesh: &Mesh) -> Vec<Vec<Plane>> {
        let mut faces_at = vec![Vec::new(); mesh.vertices.len()];
        for (corners, &face) in mesh.faces.iter().zip(&self.face_of) {
            for &v in corners {
                let at = &mut faces_at[v as usize];
                if !at.contains(&face) {
                    at.push(face);
                }
            }
        }
        for faces in &mut faces_at {
            faces.sort_unstable();
        }
        faces_at.iter().map(|faces| faces.iter().filter_map(|&f| self.planes[f]).collect()).collect()
    }
}

/// The facets across each facet's sides; `None` if the surface is not closed.
fn neighbours(mesh: &Mesh) -> Option<Vec<Vec<usize>>> {
    let facet_at = mesh.face_at_sides();
    let across = |corners: &Vec<u32>| {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| facet_at.get(&(*b, *a)).copied()).collect()
    };
    mesh.faces.iter().map(across).collect()
}

/// Twice the vector area of a facet.
fn vector_area(mesh: &Mesh, facet: usize) -> DVec3 {
    let at = |i: usize| mesh.vertices[mesh.faces[facet][i] as usize];
    (2..mesh.faces[facet].len()).map(|i| (at(i - 1) - at(0)).cross(at(i) - at(0))).sum()
}

/// The plane of facets whose vector areas add up to `area`, through the middle of their corners.
fn plane_of(mesh: &Mesh, facets: &[usize], area: DVec3) -> Option<Plane> {
    let normal = area.try_normalize()?;
    let (mut sum, mut n) = (0.0, 0.0);
    for &v in facets.iter().flat_map(|&f| &mesh.faces[f]) {
        sum += normal.dot(mesh.vertices[v as usize]);
        n += 1.0;
    }
    Some(Plane { normal, distance: sum / n })
}

/// The point nearest to `p` that lies in all planes, or least far from them; `p` where that cannot be told.
fn nearest_on_all(p: DVec3, planes: &[Plane]) -> DVec3 {
    if planes.is_empty() {
        return p;
    }
    let normals = MatrixXx3::from_fn(planes.len(), |i, axis| planes[i].normal[axis]);
    let ways = DVector::from_fn(planes.len(), |i, _| -planes[i].signed_distance(p));
    let way = normals.svd(true, true).solve(&ways, PARALLEL);
    way.map_or(p, |way| p + DVec3::new(way[0], way[1], way[2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DQuat;

    /// Outline (counter-clockwise) times height, its faces as triangles; turned askew.
    fn triangles(outline: &[(f64, f64)], height: f64) -> Mesh {
        let n = outline.len() as u32;
        let turn = DQuat::from_rotation_z(0.7) * DQuat::from_rotation_x(1.1) * DQuat::from_rotation_y(0.4);
        let ring = |z: f64| outline.iter().map(move |&(x, y)| turn * DVec3::new(x, y, z));
        let mut faces = Vec::new();
        for i in 1..n - 1 {
            faces.push(vec![0, i + 1, i]);
            faces.push(vec![n, n + i, n + i + 1]);
        }
        for i in 0..n {
            let j = (i + 1) % n;
            faces.push(vec![i, j, n + j]);
            faces.push(vec![i, n + j, n + i]);
        }
        Mesh { vertices: ring(0.0).chain(ring(height)).collect(), faces }
    }

    fn round(n: u32) -> Vec<(f64, f64)> {
        let angle = |i| f64::from(i) * std::f64::consts::TAU / f64::from(n);
        (0..n).map(|i| (0.03 * angle(i).cos(), 0.03 * angle(i).sin())).collect()
    }

    fn written(mesh: &Mesh, mut write: impl FnMut(f64) -> f64) -> Mesh {
        let vertices = mesh.vertices.iter().map(|v| DVec3::from(v.to_array().map(&mut write))).collect();
        Mesh { vertices, faces: mesh.faces.clone() }
    }

    fn decimals(n: usize) -> impl Fn(f64) -> f64 {
        move |x| format!("{x:.n$}").parse().unwrap()
    }

    fn faces(mesh: &Mesh) -> Option<usize> {
        Polyhedron::from_faces(&mesh.vertices, &mesh.faces).ok().map(|p| p.face_count())
    }

    #[test]
    fn faces_bent_by_few_digits_are_plane_again() {
        let brick = triangles(&[(0.0, 0.0), (0.05, 0.0), (0.05, 0.04), (0.0, 0.04)], 0.03);
        let mut refused = 0;
        for (part, count) in [(brick, 6), (triangles(&round(32), 0.06), 34), (triangles(&round(7), 0.01), 9)] {
            assert_eq!(faces(&part), Some(count));
            for (digits, step) in [(6, 1e-6), (7, 1e-7)] {
                let file = written(&part, decimals(digits));
                refused += usize::from(faces(&file).is_none());
                let flat = flattened(&file, tolerance(&file, MOST), 0.0).unwrap();
                assert_eq!(faces(&flat), Some(count), "{digits} decimals");
                for (a, b) in flat.vertices.iter().zip(&part.vertices) {
                    assert!(a.distance(*b) < 4.0 * step, "{digits} decimals: {a} for {b}");
                }
            }
            let single = written(&part, |x| f64::from(x as f32));
            assert_eq!(faces(&flattened(&single, tolerance(&single, MOST), 0.0).unwrap()), Some(count));
            let nine = written(&single, |x| format!("{x:.8e}").parse().unwrap());
            assert_eq!(faces(&flattened(&nine, tolerance(&nine, MOST), 0.0).unwrap()), Some(count));
        }
        assert!(refused >= 4, "only {refused} were refused as written: the test shows nothing");
    }

    #[test]
    fn slivers_that_have_collapsed_are_passed_over() {
        let mut brick = triangles(&[(0.0, 0.0), (0.05, 0.0), (0.05, 0.04), (0.0, 0.04)], 0.03);
        brick.faces.insert(3, vec![1, 2, 2]);
        assert_eq!(faces(&brick), None);
        assert_eq!(polyhedron(&brick).map(|p| p.face_count()), Ok(6));
        let bent = written(&brick, decimals(6));
        assert_eq!(polyhedron(&bent).map(|p| p.face_count()), Ok(6));
        brick.faces.remove(0);
        assert!(polyhedron(&brick).is_err());
    }

    #[test]
    fn facets_of_a_convex_part_are_one_where_only_the_last_of_seven_digits_tells_them_apart() {
        let brick = triangles(&[(0.0, 0.0), (0.05, 0.0), (0.05, 0.04), (0.0, 0.04)], 0.03);
        let single = written(&brick, |x| f64::from(x as f32));
        assert!(faces(&single).is_some_and(|n| n > 6), "{:?} faces: the test shows nothing", faces(&single));
        assert_eq!(faces(&straightened(single)), Some(6));
        // One corner of the lid a hundredth of a millimetre lower: the lid has two faces.
        let mut roof = brick;
        let up = (roof.vertices[5] - roof.vertices[1]).normalize();
        roof.vertices[5] -= 1e-5 * up;
        for file in [written(&roof, decimals(7)), written(&roof, |x| f64::from(x as f32))] {
            assert_eq!(faces(&straightened(file)), Some(7));
        }
    }

    #[test]
    fn facets_that_arithmetic_alone_has_bent_are_one_and_others_are_not() {
        let brick = triangles(&[(0.0, 0.0), (0.05, 0.0), (0.05, 0.04), (0.0, 0.04)], 0.03);
        for (noise, count) in [(1e-10, 6), (1e-7, 12)] {
            let mut i = 0.0;
            let noisy = written(&brick, |x| {
                i += 1.0;
                x + noise * f64::cos(2.0 * i)
            });
            assert!(faces(&noisy).is_some_and(|n| n > 6), "{:?} faces: the test shows nothing", faces(&noisy));
            assert_eq!(faces(&straightened(noisy)), Some(count), "{noise}");
        }
    }

    #[test]
    fn numbers_with_all_their_digits_or_somebodys_own_are_left_alone() {
        let part = triangles(&round(32), 0.06);
        assert_eq!(flattened(&part, tolerance(&part, MOST), 0.0), None);
        let mut dented = part;
        dented.vertices[3] *= 1.0 - 1e-4;
        assert!(polyhedron(&dented).is_err());
        // An L of whole numbers, and one with a step of a hundredth in its floor.
        for outline in [
            [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)],
            [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 1.01), (0.0, 1.01)],
        ] {
            let n = outline.len() as u32;
            let ring = |z: f64| outline.iter().map(move |&(x, y)| DVec3::new(x, y, z));
            let mut mesh = triangles(&outline, 1.0);
            mesh.vertices = ring(0.0).chain(ring(1.0)).collect();
            assert_eq!((flattened(&mesh, tolerance(&mesh, MOST), 0.0), mesh.vertices.len() as u32), (None, 2 * n));
        }
    }

    #[test]
    fn what_is_truly_dented_stays_so() {
        let mut part = triangles(&round(32), 0.06);
        // The lid's rim goes up by 20 steps, and beside it the lid is hollow.
        let up = (part.vertices[35] - part.vertices[3]).normalize();
        part.vertices[35] += 2e-5 * up;
        let file = written(&part, decimals(6));
        assert_eq!(faces(&file), None);
        assert_eq!(flattened(&file, tolerance(&file, MOST), 0.0).and_then(|m| faces(&m)).filter(|n| *n <= 34), None);
    }
}
