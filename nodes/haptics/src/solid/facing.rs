//! Whether the features of a basic contact face each other, and where.

use crate::solid::Pair;
use cspace::{BasicContact, CFace, FaceId, Polyhedron};
use spatial::DVec3;

/// App of a basic contact on B's side if the two features face each other (within `tolerance` metres), else none.
pub(crate) fn facing_point(pair: &Pair<'_>, c: &CFace, tolerance: f64) -> Option<DVec3> {
    let Pair { a, b, placed, .. } = *pair;
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
            let (s, t) = closest_places([a0, a1], [b0, b1])?;
            // Between the ends nothing has to be known of their distance.
            let is_on = |s: f64, along: DVec3| {
                (0.0..=1.0).contains(&s) || (s - s.clamp(0.0, 1.0)).abs() <= tolerance / along.length()
            };
            (is_on(s, ua) && is_on(t, ub)).then(|| b0 + ub * t.clamp(0.0, 1.0))
        }
    }
}

/// Where two lines come closest, each 0 to 1 between its two points; none if they are parallel.
pub(crate) fn closest_places([a0, a1]: [DVec3; 2], [b0, b1]: [DVec3; 2]) -> Option<(f64, f64)> {
    let (along_a, along_b) = (a1 - a0, b1 - b0);
    let n = along_a.cross(along_b);
    let square = n.length_squared();
    if square <= 1e-24 * along_a.length_squared() * along_b.length_squared() {
        return None;
    }
    Some(((b0 - a0).cross(along_b).dot(n) / square, (b0 - a0).cross(along_a).dot(n) / square))
}

/// Whether the foot of `p` on the face's plane lies in the face, or outside by no more than `tolerance` metres.
fn inside_ring(body: &Polyhedron, face: FaceId, p: DVec3, tolerance: f64) -> bool {
    body.face_sides(face).iter().all(|side| side.signed_distance(p) <= tolerance)
}
