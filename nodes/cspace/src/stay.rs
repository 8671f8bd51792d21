//! The quick step: Near is known to be applicable; is it still the one?

use crate::crossing::normal_between;
use crate::parallelogram::{Parallelogram, larger};
use crate::placed::Placed;
use crate::sides::{Best, may_win};
use crate::{BasicContact, Body, CFace};
use spatial::DVec3;

/// What is asked of the cosine of an angle between normals beyond rounding and ties.
const SLACK: f64 = 1e-9;

/// The plane of two edges whose arcs cross.
struct EdgePlane {
    /// Unit, axes of W.
    n: DVec3,
    /// Signed distance of `x`, metres.
    distance: f64,
    face: Parallelogram,
    /// Of the faces at B's edge.
    normals_b: [DVec3; 2],
}

impl Placed<'_> {
    /// The plane of an applicable node, and how far x's projection lies inside of the C-face's sides, metres; none if
    /// a neighbour could have a larger signed distance, or where edges are too nearly parallel to be sure.
    ///
    /// `crosses`: two edges are known to be applicable; else that is asked as well.
    /// `tan_half`: of two edges, tangent of half the angle that no neighbour's normal lies beyond.
    #[inline]
    pub(crate) fn stay(&self, node: BasicContact, crosses: bool, tan_half: f64) -> Option<(CFace, f64)> {
        let (normal_w, distance, inside) = match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let p = self.point_in_w(self.a.points[vertex_a.index()]);
                let (distance, inside) = over_face(self.b, face_b.0, p)?;
                (self.b.planes[face_b.index()].0, distance, inside)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let q = self.point_in_a(self.b.points[vertex_b.index()]);
                let (distance, inside) = over_face(self.a, face_a.0, q)?;
                (-self.turn_to_w(self.a.planes[face_a.index()].0), distance, inside)
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                let EdgePlane { n, distance, face, .. } = self.edge_plane(edge_a.0, edge_b.0, crosses)?;
                let outermost = face.outermost();
                if !(outermost + (-distance).max(0.0) * tan_half <= 0.0) {
                    return None;
                }
                (n, distance, -outermost)
            }
        };
        Some((CFace { contact: node, normal_w, distance }, inside))
    }

    /// The same by a look at each neighbour that could be better. `planes` counts them.
    #[inline]
    pub(crate) fn stay_among(&self, node: BasicContact, crosses: bool, planes: &mut u32) -> Option<(CFace, f64)> {
        let mut best = Best::NONE;
        let (normal_w, sides) = match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let p = self.point_in_w(self.a.points[vertex_a.index()]);
                let sides = self.vertex_face::<false>(vertex_a.0, face_b.0, p, &mut best, planes);
                (self.b.planes[face_b.index()].0, sides)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let q = self.point_in_a(self.b.points[vertex_b.index()]);
                let sides = self.vertex_face::<true>(vertex_b.0, face_a.0, q, &mut best, planes);
                (-self.turn_to_w(self.a.planes[face_a.index()].0), sides)
            }
            BasicContact::TypeC { edge_a, edge_b } => return self.edges_stay(edge_a.0, edge_b.0, crosses),
        };
        let face = CFace { contact: node, normal_w, distance: sides.distance };
        best.node.is_none().then_some((face, sides.inside))
    }

    /// The same of two edges: none if a plane between theirs and the end of an arc could be nearer.
    fn edges_stay(&self, edge_a: u32, edge_b: u32, crosses: bool) -> Option<(CFace, f64)> {
        let EdgePlane { n, distance, face, normals_b } = self.edge_plane(edge_a, edge_b, crosses)?;
        let rod_a = &self.a.rods[edge_a as usize];
        let under = (-distance).max(0.0);
        let stays = |s: f64, cosine: f64| !may_win(s, under, cosine - SLACK, 0.0);
        // The arcs' ends, each on the side of an end of the other edge: ties broken as everywhere, for where the edges lie in one
        // plane with a face, its normal is an end of both arcs.
        let n_a = self.turn_to_a(n);
        let normal_a = |end: usize| self.a.planes[rod_a.faces[self.arc_at_b(edge_a, edge_b, end)] as usize].0;
        let at_b = [0, 1].map(|end| -n_a.dot(normal_a(end)));
        let at_a = [0, 1].map(|end| n.dot(normals_b[self.arc_at_a(edge_a, edge_b, end)]));
        let all = (0..2).all(|end| stays(face.beyond_b[end], at_b[end]) && stays(face.beyond_a[end], at_a[end]));
        let contact = crate::c_face::type_c(edge_a, edge_b);
        all.then_some((CFace { contact, normal_w: n, distance }, -face.outermost()))
    }

    /// The plane of two edges; none if they may not cross, or are too nearly parallel to be sure.
    #[inline(always)]
    fn edge_plane(&self, edge_a: u32, edge_b: u32, crosses: bool) -> Option<EdgePlane> {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let u = self.turn_to_w(rod_a.dir);
        let normals_b = rod_b.faces.map(|f| self.b.planes[f as usize].0);
        let p = normals_b.map(|n| n.dot(u));
        let n = normal_between(normals_b, p)?;
        if !(crosses || self.surely_cross(edge_a, edge_b, p, n)) {
            return None;
        }
        let n = n.normalize();
        let w = self.between_edges(edge_a, edge_b);
        let face = Parallelogram::new(n, w, (u, rod_a.length), (rod_b.dir, rod_b.length));
        Some(EdgePlane { n, distance: n.dot(w), face, normals_b })
    }
}

/// Distance of `p` (the face's frame) to a face's plane and how far its projection lies inside the face, metres; none
/// if the plane across one of its sides could be nearer.
#[inline(always)]
fn over_face(body: &Body, face: u32, p: DVec3) -> Option<(f64, f64)> {
    let (n, d) = body.planes[face as usize];
    let distance = n.dot(p) - d;
    let under = (-distance).max(0.0);
    let (mut outermost, mut lead) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for side in body.sides(face) {
        let s = side.out.dot(p) - side.offset;
        outermost = larger(outermost, s);
        lead = larger(lead, s + under * side.tan_half);
    }
    (lead <= 0.0).then_some((distance, -outermost))
}
