//! Whether the features of a basic contact face each other, and where.

use crate::region::{Placed, RegionPoint};
use cspace::{BasicContact, CFace, FaceId, Polyhedron};
use spatial::DVec3;

/// Near's own contact if it is a vertex on a face and every other contact of the region lies more than `within` metres above
/// it along Near's normal: the vertex stands steep enough, and far enough inside the face.
pub(crate) fn lone_contact(
    a: &Polyhedron,
    b: &Polyhedron,
    placed: &Placed,
    near: &CFace,
    within: f64,
) -> Option<RegionPoint> {
    let normal_a = placed.r.transpose() * near.normal_w;
    let (body, vertex, up, sides, foot, point_w) = match near.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            let foot = placed.point(a.vertex(vertex_a)) - near.normal_w * near.distance;
            (a, vertex_a, normal_a, b.face_sides(face_b), foot, foot)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let at = b.vertex(vertex_b);
            (b, vertex_b, -near.normal_w, a.face_sides(face_a), placed.seen_from_a(at), at)
        }
        BasicContact::TypeC { .. } => return None,
    };
    // A point of the body at height h over the vertex is no farther from it than h over the least slope of its edges.
    let mut slope = f64::INFINITY;
    for (edge, neighbor) in body.vertex_edges(vertex).iter().zip(body.vertex_vertices(vertex)) {
        if up.dot(body.vertex(*neighbor) - body.vertex(vertex)) <= 2.0 * within {
            return None;
        }
        slope = slope.min(up.dot(body.edge_direction(*edge)).abs());
    }
    let clear = 2.0 * within / slope;
    sides.iter().all(|s| s.signed_distance(foot) < -clear).then(|| {
        let span_w = near.normal_w * near.distance;
        RegionPoint { contact: near.contact, point_w, normal_w: near.normal_w, gap: near.distance, span_w }
    })
}

/// App of a basic contact on B's side if the two features face each other (within `tolerance` metres), else none.
pub(crate) fn facing_point(
    a: &Polyhedron,
    b: &Polyhedron,
    placed: &Placed,
    c: &CFace,
    tolerance: f64,
) -> Option<DVec3> {
    match c.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            let p = placed.point(a.vertex(vertex_a)) - c.normal_w * c.distance;
            inside_ring(b, face_b, p, tolerance).then_some(p)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let p = b.vertex(vertex_b);
            inside_ring(a, face_a, placed.seen_from_a(p), tolerance).then_some(p)
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            let [a0, a1] = a.edge(edge_a).vertices;
            let [b0, b1] = b.edge(edge_b).vertices;
            let (a0, a1) = (placed.point(a.vertex(a0)), placed.point(a.vertex(a1)));
            let (b0, b1) = (b.vertex(b0), b.vertex(b1));
            let (ua, ub) = (a1 - a0, b1 - b0);
            // Parameters of the closest points of the two lines.
            let n = ua.cross(ub);
            let nn = n.length_squared();
            if nn <= 1e-24 * ua.length_squared() * ub.length_squared() {
                return None;
            }
            let s = (b0 - a0).cross(ub).dot(n) / nn;
            let t = (b0 - a0).cross(ua).dot(n) / nn;
            let (ts, tt) = (tolerance / ua.length(), tolerance / ub.length());
            (s >= -ts && s <= 1.0 + ts && t >= -tt && t <= 1.0 + tt).then(|| b0 + ub * t.clamp(0.0, 1.0))
        }
    }
}

/// Whether the foot of `p` on the face's plane lies in the face, or outside by no more than `tolerance` metres.
fn inside_ring(body: &Polyhedron, face: FaceId, p: DVec3, tolerance: f64) -> bool {
    body.face_sides(face).iter().all(|side| side.signed_distance(p) <= tolerance)
}
