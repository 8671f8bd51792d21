//! How much of a face lies inside other pieces of its body.

use cspace::{FaceId, Polyhedron, cut_out, polygon_area};
use spatial::DVec3;

/// How much of a face lies inside other pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cover {
    /// None of it: a face of the solid.
    Open,
    /// A part of it.
    Partial,
    /// All of it: never felt.
    Internal,
}

/// What is left of the face when every other piece has been cut out of it, a little outside of the face, by area.
///
/// Several pieces may cover a face together that none covers alone: what one leaves open is cut by the next.
pub(crate) fn cover_of<'a>(
    piece: &Polyhedron,
    face: FaceId,
    others: impl Iterator<Item = &'a Polyhedron>,
    tolerance: f64,
) -> Cover {
    let normal = piece.face_plane(face).normal;
    let ring: Vec<DVec3> = piece.face_vertices(face).iter().map(|v| piece.vertex(*v)).collect();
    let whole = polygon_area(&ring, normal);
    // A cut near a tip: what covers it narrows, and a little outside of the face leaves a strip open around it.
    let around: f64 = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum();
    let strip = 16.0 * tolerance * around;
    let mut open = vec![ring];
    for other in others {
        let height = |f: FaceId| {
            let plane = other.face_plane(f);
            move |p: DVec3| plane.signed_distance(p + normal * (4.0 * tolerance)) - tolerance
        };
        let heights: Vec<_> = other.faces().map(height).collect();
        open = open.into_iter().flat_map(|polygon| cut_out(polygon, &heights).0).collect();
    }
    let left: f64 = open.iter().map(|polygon| polygon_area(polygon, normal)).sum();
    if left <= 1e-4 * whole + strip {
        Cover::Internal
    } else if left < (1.0 - 1e-6) * whole {
        Cover::Partial
    } else {
        Cover::Open
    }
}
