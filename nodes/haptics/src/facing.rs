//! Whether the features of a basic contact face each other, and where.

use crate::pair::Pair;
use crate::region::RegionPoint;
use cspace::{BasicContact, CFace, EdgeId, FaceId, Plane, Polyhedron, VertexId};
use spatial::DVec3;

/// Near's own contact if every other contact of the region lies more than `within` metres above it along Near's normal: a
/// vertex that stands steep enough, and far enough inside the face, or two edges that cross steeply far from their ends.
pub(crate) fn lone_contact(pair: &Pair<'_>, near: &CFace, within: f64) -> Option<RegionPoint> {
    let Pair { a, b, placed, .. } = *pair;
    let normal_a = placed.r.transpose() * near.normal_w;
    let point_w = match near.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            let foot = placed.point(a.vertex(vertex_a)) - near.normal_w * near.distance;
            let clear = clear_of_vertex(a, vertex_a, normal_a, within)?;
            is_inside(b.face_sides(face_b), foot, clear).then_some(foot)?
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let at = b.vertex(vertex_b);
            let clear = clear_of_vertex(b, vertex_b, -near.normal_w, within)?;
            is_inside(a.face_sides(face_a), placed.seen_from_a(at), clear).then_some(at)?
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            let at = facing_point(pair, near, 0.0)?;
            let (on_a, along_a) = (placed.seen_from_a(at + near.normal_w * near.distance), a.edge_direction(edge_a));
            let cross = (placed.r * along_a).cross(b.edge_direction(edge_b)).length();
            let slope = slope_of_edge(a, edge_a, -normal_a).min(slope_of_edge(b, edge_b, near.normal_w));
            let clear = 2.0 * within / (slope * cross);
            let stands = |body: &Polyhedron, edge: EdgeId, at: DVec3| {
                body.edge(edge).faces.iter().all(|f| {
                    let others = body.face_edges(*f).iter().zip(body.face_sides(*f)).filter(|(e, _)| **e != edge);
                    others.map(|(_, side)| side).all(|s| s.signed_distance(at) < -clear)
                })
            };
            (stands(a, edge_a, on_a) && stands(b, edge_b, at)).then_some(at)?
        }
    };
    Some(RegionPoint::of(near, point_w))
}

/// Beyond this distance from the vertex, metres, the body lies more than twice `within` above it; none if a neighbour does not.
fn clear_of_vertex(body: &Polyhedron, vertex: VertexId, up: DVec3, within: f64) -> Option<f64> {
    let at = body.vertex(vertex);
    // A point of the body at height h over the vertex is no farther from it than h over the least slope of its edges.
    let mut slope = f64::INFINITY;
    for (edge, neighbor) in body.vertex_edges(vertex).iter().zip(body.vertex_vertices(vertex)) {
        if up.dot(body.vertex(*neighbor) - at) <= 2.0 * within {
            return None;
        }
        slope = slope.min(up.dot(body.edge_direction(*edge)).abs());
    }
    Some(2.0 * within / slope)
}

/// The lesser slope at which the faces at an edge fall away from the plane through the edge with this outward normal.
fn slope_of_edge(body: &Polyhedron, edge: EdgeId, outward: DVec3) -> f64 {
    let across = body.edge_direction(edge).cross(outward);
    body.edge(edge).faces.iter().map(|f| body.face_plane(*f).normal.dot(across).abs()).fold(f64::INFINITY, f64::min)
}

/// Whether `p` lies inside of all sides by more than `clear` metres.
fn is_inside(sides: &[Plane], p: DVec3, clear: f64) -> bool {
    sides.iter().all(|s| s.signed_distance(p) < -clear)
}

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
            let (ts, tt) = (tolerance / ua.length(), tolerance / ub.length());
            (s >= -ts && s <= 1.0 + ts && t >= -tt && t <= 1.0 + tt).then(|| b0 + ub * t.clamp(0.0, 1.0))
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
