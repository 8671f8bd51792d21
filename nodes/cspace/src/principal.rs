use crate::{BasicContact, CFace, EdgeId, FaceId, Polyhedron};
use spatial::{DVec3, Pose};

/// Directions that differ by less than this angle (radians) are parallel: aligned faces of files with seven digits are,
/// a hand's pose never is by chance.
pub const PARALLEL_ANGLE: f64 = 1e-7;

/// The principal contact of one pair (paper, footnote 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrincipalContact {
    /// A vertex on a face.
    VertexFace,
    /// Two edges.
    EdgeEdge,
    /// An edge on a face (paper, Figure 4).
    EdgeFace,
    /// Two faces (paper, Figure 5).
    FaceFace,
}

/// The principal contact that Near is part of at this pose, and the number K of basic contacts that take place: the
/// corners of the contact region (paper, section IV.B). For the record and for pictures: it allocates.
#[must_use]
pub fn principal_contact(near: &CFace, a: &Polyhedron, b: &Polyhedron, pose: &Pose) -> (PrincipalContact, usize) {
    let n = near.normal_w;
    let edge;
    let (faces_a, faces_b, edges_a, edges_b): (&[FaceId], &[FaceId], &[EdgeId], &[EdgeId]);
    let mut face = [FaceId(0)];
    let (sides_a, sides_b);
    match near.contact {
        BasicContact::TypeA { face_a, vertex_b } => {
            face[0] = face_a;
            (faces_a, edges_a) = (&face, &[]);
            (faces_b, edges_b) = (b.vertex_faces(vertex_b), b.vertex_edges(vertex_b));
        }
        BasicContact::TypeB { vertex_a, face_b } => {
            face[0] = face_b;
            (faces_a, edges_a) = (a.vertex_faces(vertex_a), a.vertex_edges(vertex_a));
            (faces_b, edges_b) = (&face, &[]);
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            (sides_a, sides_b) = (a.edge(edge_a).faces, b.edge(edge_b).faces);
            edge = ([edge_a], [edge_b]);
            (faces_a, faces_b, edges_a, edges_b) = (&sides_a, &sides_b, &edge.0, &edge.1);
        }
    }
    let flat_a = faces_a.iter().find(|f| (pose.rotation * a.face_plane(**f).normal + n).length() < PARALLEL_ANGLE);
    let flat_b = faces_b.iter().find(|f| (b.face_plane(**f).normal - n).length() < PARALLEL_ANGLE);
    let lies = |direction: DVec3| direction.dot(n).abs() < PARALLEL_ANGLE;
    let outline_a =
        |f: &FaceId| -> Vec<DVec3> { a.face_vertices(*f).iter().map(|v| pose.transform_point(a.vertex(*v))).collect() };
    let outline_b = |f: &FaceId| -> Vec<DVec3> { b.face_vertices(*f).iter().map(|v| b.vertex(*v)).collect() };
    let same = 1e-9 * (a.size() + b.size());
    let count = match (flat_a, flat_b) {
        (Some(f), Some(g)) => clip(outline_a(f), &outline_b(g), n, same),
        (None, Some(g)) => {
            let along = edges_a.iter().find(|e| lies(pose.rotation * a.edge_direction(**e)));
            along.map_or(0, |e| {
                let ends = a.edge(*e).vertices.map(|v| pose.transform_point(a.vertex(v)));
                clip(ends.to_vec(), &outline_b(g), n, same)
            })
        }
        (Some(f), None) => {
            let along = edges_b.iter().find(|e| lies(b.edge_direction(**e)));
            along.map_or(0, |e| {
                // A's face is wound clockwise seen along n.
                let mut outline: Vec<DVec3> = outline_a(f);
                outline.reverse();
                clip(b.edge(*e).vertices.map(|v| b.vertex(v)).to_vec(), &outline, n, same)
            })
        }
        (None, None) => return (PrincipalContact::EdgeEdge, 1),
    };
    match count {
        0 | 1 => match near.contact {
            BasicContact::TypeC { .. } => (PrincipalContact::EdgeEdge, 1),
            _ => (PrincipalContact::VertexFace, 1),
        },
        2 => (PrincipalContact::EdgeFace, 2),
        k => (PrincipalContact::FaceFace, k),
    }
}

/// Corners left of a polygon or segment after cutting it by the sides of a polygon that is counter-clockwise about `n`,
/// seen along `n` (Sutherland and Hodgman 1974). Corners nearer than `same` are one.
fn clip(mut subject: Vec<DVec3>, window: &[DVec3], n: DVec3, same: f64) -> usize {
    let mut result: Vec<DVec3> = Vec::with_capacity(subject.len() + window.len());
    for i in 0..window.len() {
        let start = window[i];
        let inward = n.cross(window[(i + 1) % window.len()] - start).normalize_or_zero();
        result.clear();
        for k in 0..subject.len() {
            let (p, q) = (subject[k], subject[(k + 1) % subject.len()]);
            let (hp, hq) = (inward.dot(p - start), inward.dot(q - start));
            if hp >= -same {
                result.push(p);
            }
            if (hp >= -same) != (hq >= -same) {
                result.push(p + (q - p) * (hp / (hp - hq)).clamp(0.0, 1.0));
            }
        }
        std::mem::swap(&mut subject, &mut result);
    }
    let mut corners: Vec<DVec3> = Vec::with_capacity(subject.len());
    for p in subject {
        let flat = p - n * n.dot(p);
        if corners.iter().all(|c| c.distance(flat) > 10.0 * same) {
            corners.push(flat);
        }
    }
    corners.len()
}
