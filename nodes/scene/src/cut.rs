use crate::Mesh;
use crate::hull::hull;
use cspace::Plane;
use spatial::DVec3;
use std::f64::consts::TAU;

/// Bounds of the exact method: beyond them a mesh is a scan or a curved thing, and an approximation serves better.
const MAX_TRIANGLES: usize = 2_000;
const MAX_CELLS: usize = 400;

/// Cuts a closed solid into convex pieces that fill it exactly: starting from its convex hull, cut along the planes of
/// the faces that lie inside a cell until no face does, keep the cells that are inside, and join neighbours whose
/// union is convex. `None` when the solid is too large for this or the cells do not add up to its volume (a surface
/// that is not closed, or crosses itself).
pub fn cut_into_convex(solid: &Mesh) -> Option<Vec<Mesh>> {
    let eps = 1e-9 * solid.size();
    let triangles: Vec<[DVec3; 3]> = solid.triangles().filter(|t| area(t) > eps * eps).collect();
    if triangles.len() > MAX_TRIANGLES {
        return None;
    }
    let whole = hull(&solid.vertices).ok()?;
    let faces = whole.faces.iter().map(|f| f.iter().map(|&i| whole.vertices[i as usize]).collect()).collect();
    let fragments = triangles.iter().map(|t| Fragment { plane: plane_of(t), polygon: t.to_vec() }).collect();
    let mut open = vec![Cell { faces, fragments }];
    let mut inside = Vec::new();
    while let Some(mut cell) = open.pop() {
        cell.drop_boundary_fragments(eps);
        let Some(plane) = cell.best_cut(eps) else {
            if winding_number(&triangles, cell.center()) > 0.5 {
                inside.push(cell.into_mesh());
            }
            continue;
        };
        if open.len() + inside.len() > MAX_CELLS {
            return None;
        }
        open.extend(cell.split(plane, eps).into_iter().flatten());
    }
    join_neighbours(&mut inside, solid.size());
    let sum: f64 = inside.iter().map(Mesh::volume).sum();
    let volume = solid.volume();
    ((sum - volume).abs() <= 1e-6 * volume).then_some(inside)
}

/// The part of a face of the solid that lies in a cell.
struct Fragment {
    plane: Plane,
    polygon: Vec<DVec3>,
}

/// A convex cell and what of the solid's surface lies in it.
struct Cell {
    faces: Vec<Vec<DVec3>>,
    fragments: Vec<Fragment>,
}

impl Cell {
    fn center(&self) -> DVec3 {
        let (mut sum, mut n) = (DVec3::ZERO, 0.0);
        for p in self.faces.iter().flatten() {
            sum += *p;
            n += 1.0;
        }
        sum / n
    }

    fn spans(&self, plane: &Plane, eps: f64) -> bool {
        let heights = || self.faces.iter().flatten().map(|p| plane.signed_distance(*p));
        heights().any(|h| h > eps) && heights().any(|h| h < -eps)
    }

    fn drop_boundary_fragments(&mut self, eps: f64) {
        let mut fragments = std::mem::take(&mut self.fragments);
        fragments.retain(|f| self.spans(&f.plane, eps));
        self.fragments = fragments;
    }

    /// The plane that splits the fewest other fragments; `None` when nothing is left inside.
    fn best_cut(&self, eps: f64) -> Option<Plane> {
        let splits = |plane: &Plane| {
            let crossed = |f: &&Fragment| side(&f.polygon, plane, eps) == Side::Both;
            self.fragments.iter().filter(crossed).count()
        };
        // A look at some of them is enough where there are many.
        let stride = self.fragments.len() / 64 + 1;
        self.fragments.iter().step_by(stride).map(|f| f.plane).min_by_key(splits)
    }

    /// The halves above and below the plane.
    fn split(self, plane: Plane, eps: f64) -> [Option<Self>; 2] {
        let below = Plane { normal: -plane.normal, distance: -plane.distance };
        [self.half(plane, eps), self.half(below, eps)]
    }

    fn half(&self, plane: Plane, eps: f64) -> Option<Self> {
        let mut faces: Vec<Vec<DVec3>> = self.faces.iter().filter_map(|f| above(f, &plane, eps)).collect();
        let cap = cap(&faces, &plane, eps)?;
        faces.push(cap);
        let keep = |f: &Fragment| above(&f.polygon, &plane, eps).map(|polygon| Fragment { plane: f.plane, polygon });
        let fragments = self.fragments.iter().filter_map(keep).collect();
        Some(Self { faces, fragments })
    }

    fn into_mesh(self) -> Mesh {
        let mut mesh = Mesh::default();
        for face in self.faces {
            let first = mesh.vertices.len() as u32;
            mesh.faces.push((first..first + face.len() as u32).collect());
            mesh.vertices.extend(face);
        }
        mesh.welded()
    }
}

#[derive(PartialEq)]
enum Side {
    Above,
    Below,
    On,
    Both,
}

fn side(polygon: &[DVec3], plane: &Plane, eps: f64) -> Side {
    let up = polygon.iter().any(|p| plane.signed_distance(*p) > eps);
    let down = polygon.iter().any(|p| plane.signed_distance(*p) < -eps);
    match (up, down) {
        (true, true) => Side::Both,
        (true, false) => Side::Above,
        (false, true) => Side::Below,
        (false, false) => Side::On,
    }
}

/// What of a convex polygon lies above the plane; `None` if nothing but an edge does.
fn above(polygon: &[DVec3], plane: &Plane, eps: f64) -> Option<Vec<DVec3>> {
    match side(polygon, plane, eps) {
        Side::Above => return Some(polygon.to_vec()),
        Side::Below | Side::On => return None,
        Side::Both => {}
    }
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (hp, hq) = (plane.signed_distance(p), plane.signed_distance(q));
        if hp >= -eps {
            kept.push(p);
        }
        if (hp > eps && hq < -eps) || (hp < -eps && hq > eps) {
            kept.push(crossing(p, q, plane));
        }
    }
    (kept.len() >= 3).then_some(kept)
}

/// Where the edge crosses the plane. The ends are taken in one order and the plane in one sense, so that all faces and
/// both halves get the very same bits.
fn crossing(p: DVec3, q: DVec3, plane: &Plane) -> DVec3 {
    let (p, q) = if p.to_array() <= q.to_array() { (p, q) } else { (q, p) };
    let (hp, hq) = (plane.signed_distance(p), plane.signed_distance(q));
    p + (q - p) * (hp / (hp - hq))
}

/// The face that closes a cut: the corners of the remaining faces that lie in the plane, counter-clockwise seen from below.
fn cap(faces: &[Vec<DVec3>], plane: &Plane, eps: f64) -> Option<Vec<DVec3>> {
    let mut corners: Vec<DVec3> = Vec::new();
    for p in faces.iter().flatten().filter(|p| plane.signed_distance(**p).abs() <= eps) {
        if !corners.contains(p) {
            corners.push(*p);
        }
    }
    if corners.len() < 3 {
        return None;
    }
    let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let u = (corners[0] - center).normalize();
    let v = u.cross(plane.normal);
    let angle = |p: &DVec3| (*p - center).dot(v).atan2((*p - center).dot(u)).rem_euclid(TAU);
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    Some(corners)
}

/// How often the surface winds around `p`: one inside, zero outside (van Oosterom and Strackee 1983).
fn winding_number(triangles: &[[DVec3; 3]], p: DVec3) -> f64 {
    let solid_angle = |t: &[DVec3; 3]| {
        let [a, b, c] = t.map(|v| v - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    triangles.iter().map(solid_angle).sum::<f64>() / (2.0 * TAU)
}

/// Joins pieces two by two while the hull of a pair holds no more than the pair.
fn join_neighbours(pieces: &mut Vec<Mesh>, size: f64) {
    let tolerance = 1e-9 * size * size * size;
    let mut i = 0;
    while i < pieces.len() {
        let joined = (i + 1..pieces.len()).find_map(|j| {
            let points: Vec<DVec3> = pieces[i].vertices.iter().chain(&pieces[j].vertices).copied().collect();
            let union = hull(&points).ok()?;
            let extra = union.volume() - pieces[i].volume() - pieces[j].volume();
            (extra <= tolerance).then_some((j, union))
        });
        match joined {
            Some((j, union)) => {
                pieces[i] = union;
                pieces.remove(j);
                // A larger piece may now fit with one that was passed over.
                i = 0;
            }
            None => i += 1,
        }
    }
}

fn plane_of(t: &[DVec3; 3]) -> Plane {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
    Plane { normal, distance: normal.dot(t[0]) }
}

fn area(t: &[DVec3; 3]) -> f64 {
    0.5 * (t[1] - t[0]).cross(t[2] - t[0]).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A prism of height 1 over a counter-clockwise outline.
    fn prism(outline: &[(f64, f64)]) -> Mesh {
        let n = outline.len() as u32;
        let ring = |z: f64| outline.iter().map(move |&(x, y)| DVec3::new(x, y, z));
        let mut faces: Vec<Vec<u32>> = (0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]).collect();
        // The outlines here are seen whole from their first corner, so fans triangulate them.
        for i in 1..n - 1 {
            faces.push(vec![0, i + 1, i]);
            faces.push(vec![n, n + i, n + i + 1]);
        }
        Mesh { vertices: ring(0.0).chain(ring(1.0)).collect(), faces }
    }

    #[test]
    fn an_angle_is_two_boxes() {
        let angle = prism(&[(1.0, 1.0), (0.0, 3.0), (0.0, 0.0), (3.0, 0.0), (3.0, 1.0)]);
        let angle = Mesh { vertices: angle.vertices, faces: angle.faces };
        let pieces = cut_into_convex(&angle).unwrap();
        assert_eq!(pieces.len(), 2);
        assert!((pieces.iter().map(Mesh::volume).sum::<f64>() - angle.volume()).abs() < 1e-12);
    }

    #[test]
    fn a_frame_with_a_hole_is_cut_without_loss() {
        // Outer square 4 x 4, hole 2 x 2 through it.
        let square = |h: f64| [(-h, -h), (h, -h), (h, h), (-h, h)];
        let mut vertices = Vec::new();
        for (h, z) in [(2.0, 0.0), (2.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
            vertices.extend(square(h).map(|(x, y)| DVec3::new(x, y, z)));
        }
        let mut faces = Vec::new();
        for i in 0..4u32 {
            let j = (i + 1) % 4;
            faces.push(vec![i, j, 4 + j, 4 + i]);
            faces.push(vec![8 + j, 8 + i, 12 + i, 12 + j]);
            faces.push(vec![4 + i, 4 + j, 12 + j, 12 + i]);
            faces.push(vec![j, i, 8 + i, 8 + j]);
        }
        let frame = Mesh { vertices, faces };
        assert!((frame.volume() - 12.0).abs() < 1e-12);
        let pieces = cut_into_convex(&frame).unwrap();
        assert_eq!(pieces.len(), 4, "four bars");
        assert!((pieces.iter().map(Mesh::volume).sum::<f64>() - 12.0).abs() < 1e-9);
        // No piece reaches into the hole.
        assert!(pieces.iter().all(|p| {
            let center = p.vertices.iter().sum::<DVec3>() / p.vertices.len() as f64;
            center.x.abs().max(center.y.abs()) > 1.0
        }));
    }

    #[test]
    fn an_open_surface_is_not_a_solid() {
        let mut angle = prism(&[(1.0, 1.0), (0.0, 3.0), (0.0, 0.0), (3.0, 0.0), (3.0, 1.0)]);
        angle.faces.remove(0);
        assert!(cut_into_convex(&angle).is_none());
    }
}
