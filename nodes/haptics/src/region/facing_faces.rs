//! Which faces of a pair are laid on each other.

use crate::solid::{Cover, Pair};
use cspace::{BasicContact, CFace, FaceId};

/// The cosine between outward normals up to which faces count as facing each other.
pub(crate) const FACING: f64 = -0.5;

/// The pair of faces, one of each body, at the features of `near` that are most nearly antiparallel.
pub(crate) fn most_parallel(pair: &Pair<'_>, near: &CFace) -> Option<(FaceId, FaceId)> {
    Some(most_parallel_by(pair, near)?.0)
}

/// The same, and by how much the cosine is less than that of any other pair there.
pub(crate) fn most_parallel_by(pair: &Pair<'_>, near: &CFace) -> Option<((FaceId, FaceId), f64)> {
    let (mut best, mut least, mut next) = (None, f64::INFINITY, f64::INFINITY);
    for_each_pair(pair, near, |cosine, faces| {
        if cosine < least {
            (best, least, next) = (Some(faces), cosine, least);
        } else {
            next = next.min(cosine);
        }
    });
    Some((best?, next - least))
}

/// The pairs of faces at the features of `near` that face each other: the most nearly antiparallel, and as many others as
/// `out` has room for.
pub(crate) fn facing_pairs(pair: &Pair<'_>, near: &CFace, out: &mut Vec<(FaceId, FaceId)>) {
    out.extend(most_parallel(pair, near));
    for_each_pair(pair, near, |cosine, faces| {
        if cosine < FACING && out.len() < out.capacity() && out.first() != Some(&faces) {
            out.push(faces);
        }
    });
}

/// Adds to the pair of faces that was chosen at two crossing edges those of the other faces there that the other body's edge lies
/// along, within `reach` metres: it crosses their far sides, too, and all these places bound the motion.
pub(crate) fn pairs_along_edges(pair: &Pair<'_>, near: &CFace, reach: f64, out: &mut Vec<(FaceId, FaceId)>) {
    if let Some(&chosen) = out.first() {
        each_beside_chosen(pair, near, chosen, |height, faces| {
            if height <= reach {
                out.push(faces);
            }
        });
    }
}

/// Gives `each`, at two crossing edges, the other faces there with the chosen one that the other edge belongs to; and how high that edge
/// rises over it, over the length of its body, metres.
pub(crate) fn each_beside_chosen(
    pair: &Pair<'_>,
    near: &CFace,
    chosen: (FaceId, FaceId),
    mut each: impl FnMut(f64, (FaceId, FaceId)),
) {
    let Pair { solids, a, b, part, piece, placed } = *pair;
    let BasicContact::TypeC { edge_a, edge_b } = near.contact else { return };
    let along_a = placed.r * a.edge_direction(edge_a);
    let along_b = placed.r.transpose() * b.edge_direction(edge_b);
    for face_a in a.edge(edge_a).faces {
        if face_a != chosen.0 && !solids.is_internal_a(part, face_a) {
            each(a.face_plane(face_a).normal.dot(along_b).abs() * a.size(), (face_a, chosen.1));
        }
    }
    for face_b in b.edge(edge_b).faces {
        if face_b != chosen.1 && !solids.is_internal_b(piece, face_b) {
            each(b.face_plane(face_b).normal.dot(along_a).abs() * b.size(), (chosen.0, face_b));
        }
    }
}

/// Calls `each` with the pairs of surface faces at the features of `near`, and the cosine between their outward normals.
fn for_each_pair(pair: &Pair<'_>, near: &CFace, mut each: impl FnMut(f64, (FaceId, FaceId))) {
    let Pair { solids, a, b, part, piece, placed } = *pair;
    let (one_a, one_b);
    let (edge_a_faces, edge_b_faces);
    let (faces_a, faces_b): (&[FaceId], &[FaceId]) = match near.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            one_b = [face_b];
            (a.vertex_faces(vertex_a), &one_b)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            one_a = [face_a];
            (&one_a, b.vertex_faces(vertex_b))
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            (edge_a_faces, edge_b_faces) = (a.edge(edge_a).faces, b.edge(edge_b).faces);
            (&edge_a_faces, &edge_b_faces)
        }
    };
    let (covers_a, covers_b) = (solids.moving.covers(part), solids.fixed.covers(piece));
    for i in faces_a.iter().filter(|f| covers_a[f.index()] != Cover::Internal) {
        let normal = placed.r * a.face_plane(*i).normal;
        for j in faces_b.iter().filter(|f| covers_b[f.index()] != Cover::Internal) {
            each(b.face_plane(*j).normal.dot(normal), (*i, *j));
        }
    }
}
