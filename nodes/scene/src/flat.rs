//! Faces that the digits of a file have bent: a face's triangles, written with six digits, lie in one plane no longer.

use crate::Mesh;
use crate::mesh::position_bits;
use cspace::{Plane, Polyhedron, PolyhedronError};
use spatial::{DMat3, DVec3};
use std::collections::HashMap;

/// A vertex of a face lies at most this many steps of the file's last digit off its plane: it is rounded itself, by 0.87
/// at most, and so are those through which the plane was laid.
const STEPS: f64 = 4.0;
/// Fewer digits than these are somebody's own numbers, not rounded ones.
const LEAST_DIGITS: i32 = 5;
/// Facets as flat as this, of the size, are one face however many digits there are: so much is left of CAD's own arithmetic.
const LEAST: f64 = 1e-8;
/// The most that digits may leave open, of the size: where a surface is dented, and where it is convex as it stands.
const MOST: f64 = 1e-4;
const MOST_OF_CONVEX: f64 = 1e-6;

/// The polyhedron of a mesh. Where it is not convex as it stands, its faces are made plane as far as the digits of the
/// coordinates leave that open, without the slivers that they have made lines of. Vertices and faces count as in the mesh.
///
/// # Errors
/// The mesh is not convex, however the digits are read.
pub fn polyhedron(mesh: &Mesh) -> Result<Polyhedron, PolyhedronError> {
    let whole = |m: &Mesh| Polyhedron::from_faces(&m.vertices, &m.faces);
    whole(mesh).or_else(|refused| {
        let sound = mesh.without_collapsed_faces();
        whole(&sound).or_else(|_| flattened(&sound, MOST).and_then(|m| whole(&m).ok()).ok_or(refused))
    })
}

/// The mesh with faces made plane where the digits of its coordinates have bent them: dented ones would be cut into slivers,
/// and of bulging ones contact would know only a facet at a time.
#[must_use]
pub fn straightened(mesh: Mesh) -> Mesh {
    let faces = |m: &Mesh| Polyhedron::from_faces(&m.vertices, &m.faces).map(|p| p.face_count());
    let flat = match faces(&mesh) {
        Err(_) => flattened(&mesh, MOST),
        Ok(count) => flattened(&mesh, MOST_OF_CONVEX).filter(|m| faces(m).is_ok_and(|flat| flat < count)),
    };
    flat.unwrap_or(mesh)
}

/// The mesh with faces made plane as far as the digits of its coordinates leave that open, `most` of the size at most, its
/// vertices and faces in the same order; `None` where they do not, or where it cannot be done.
fn flattened(mesh: &Mesh, most: f64) -> Option<Mesh> {
    let size = mesh.size();
    let digits = last_digit(&mesh.vertices).map_or(0.0, |step| STEPS * step);
    let tolerance = digits.clamp(LEAST * size, most * size);
    let welded = mesh.welded();
    let faces = Faces::of(&welded, tolerance)?;
    let mut bent = 0.0f64;
    let mut moved_from = HashMap::with_capacity(welded.vertices.len());
    for (vertex, planes) in welded.vertices.iter().zip(faces.through_vertices(&welded)) {
        let moved = nearest_on_all(*vertex, &planes);
        let way = moved.distance(*vertex);
        // Planes that are nearly parallel meet far away.
        if !(way <= 3.0 * tolerance) {
            return None;
        }
        bent = bent.max(way);
        moved_from.insert(position_bits(*vertex), moved);
    }
    let vertices = mesh.vertices.iter().filter_map(|v| moved_from.get(&position_bits(*v)).copied()).collect();
    (bent > 1e-12 * size).then(|| Mesh { vertices, faces: mesh.faces.clone() })
}

/// The step of the last digit that the coordinates were written with, in their unit; `None` where they are too short to
/// be rounded ones.
fn last_digit(vertices: &[DVec3]) -> Option<f64> {
    let numbers = || vertices.iter().flat_map(|v| v.to_array()).filter(|x| *x != 0.0);
    let largest = numbers().fold(0.0, |most: f64, x| most.max(x.abs()));
    // Single precision, written in binary or with the nine digits that it takes.
    if numbers().all(|x| (x - f64::from(x as f32)).abs() <= 5.1e-9 * x.abs()) {
        return Some(largest * f64::from(f32::EPSILON));
    }
    let (mut decimals, mut digits) = (i32::MIN, 0);
    for x in numbers() {
        // `1.2345e-2`: the shortest text that reads back.
        let text = format!("{:e}", x.abs());
        let (mantissa, exponent) = text.split_once('e')?;
        let written = mantissa.len() as i32 - i32::from(mantissa.contains('.'));
        digits = digits.max(written);
        decimals = decimals.max(written - 1 - exponent.parse::<i32>().ok()?);
    }
    let leading = largest.log10().floor() as i32;
    // Files with a fixed number of decimals and files with a fixed number of digits: the coarser is what they agree on.
    (digits >= LEAST_DIGITS).then(|| 10f64.powi((-decimals).max(leading + 1 - digits)))
}

/// Which facets of the file make one face, and its plane.
struct Faces {
    face_of: Vec<usize>,
    /// `None` for a triangle by itself, which is plane wherever its corners are.
    planes: Vec<Option<Plane>>,
}

impl Faces {
    /// Grows faces from the largest facets on, as far as neighbours lie in the plane of what has grown.
    fn of(mesh: &Mesh, tolerance: f64) -> Option<Self> {
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
            let corners = members.iter().flat_map(|&f| &mesh.faces[f]);
            if corners.clone().any(|&v| plane.signed_distance(mesh.vertices[v as usize]).abs() > tolerance) {
                return None;
            }
            planes.push((members.len() > 1 || mesh.faces[seed].len() > 3).then_some(plane));
        }
        Some(Self { face_of, planes })
    }

    /// For each vertex the planes that it has to lie in.
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
        faces_at.iter().map(|faces| faces.iter().filter_map(|&f| self.planes[f]).collect()).collect()
    }
}

/// The facets across each facet's sides; `None` if the surface is not closed.
fn neighbours(mesh: &Mesh) -> Option<Vec<Vec<usize>>> {
    let sides = |f: usize| {
        let corners = &mesh.faces[f];
        (0..corners.len()).map(move |i| (corners[i], corners[(i + 1) % corners.len()]))
    };
    let facet_at: HashMap<(u32, u32), usize> =
        (0..mesh.faces.len()).flat_map(|f| sides(f).map(move |side| (side, f))).collect();
    (0..mesh.faces.len()).map(|f| sides(f).map(|(a, b)| facet_at.get(&(b, a)).copied()).collect()).collect()
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

/// The point nearest to `p` that lies in all planes, or least far from them.
fn nearest_on_all(p: DVec3, planes: &[Plane]) -> DVec3 {
    let outer = |n: DVec3| DMat3::from_cols(n * n.x, n * n.y, n * n.z);
    // Least squares; what is added to the diagonal leaves alone the directions that no plane asks for.
    let inverse = planes.iter().fold(DMat3::IDENTITY * 1e-9, |sum, plane| sum + outer(plane.normal)).inverse();
    (0..3).fold(p, |at, _| {
        at + inverse * planes.iter().map(|plane| plane.normal * -plane.signed_distance(at)).sum::<DVec3>()
    })
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
                let flat = flattened(&file, MOST).unwrap();
                assert_eq!(faces(&flat), Some(count), "{digits} decimals");
                for (a, b) in flat.vertices.iter().zip(&part.vertices) {
                    assert!(a.distance(*b) < 4.0 * step, "{digits} decimals: {a} for {b}");
                }
            }
            let single = written(&part, |x| f64::from(x as f32));
            assert_eq!(faces(&flattened(&single, MOST).unwrap()), Some(count));
            let nine = written(&single, |x| format!("{x:.8e}").parse().unwrap());
            assert_eq!(faces(&flattened(&nine, MOST).unwrap()), Some(count));
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
        assert_eq!(flattened(&part, MOST), None);
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
            assert_eq!((flattened(&mesh, MOST), mesh.vertices.len() as u32), (None, 2 * n));
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
        assert_eq!(flattened(&file, MOST).and_then(|m| faces(&m)).filter(|n| *n <= 34), None);
    }
}
