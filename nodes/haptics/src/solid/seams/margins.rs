//! By how much a contact is one of the uncut solid, or is not: what is found of it holds as long as it moves by less.

use super::Seams;
use cspace::{EdgeId, FaceId, VertexId};
use spatial::DVec3;

/// Whether a contact is felt, and while it moves by no more than what, metres and radians, that is sure to stay so.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    pub felt: bool,
    /// Of the point along its edge.
    pub way: f64,
    /// Of the normal.
    pub turn: f64,
}

impl Margin {
    pub const ANYWHERE: Self = Self { felt: true, way: f64::INFINITY, turn: f64::INFINITY };

    /// What both say together.
    pub fn and(self, other: Self) -> Self {
        match (self.felt, other.felt) {
            (true, true) => Self { felt: true, way: self.way.min(other.way), turn: self.turn.min(other.turn) },
            (false, _) => self,
            (true, false) => other,
        }
    }
}

impl Seams {
    /// How far the place just outside of the face at `point` lies outside of all other pieces, metres; zero or less where it is
    /// covered: see [`Seams::is_covered`].
    pub fn uncovered_by(&self, piece: usize, face: FaceId, point: DVec3) -> f64 {
        let outside = point + self.pieces[piece].face_plane(face).normal * (4.0 * self.tolerance);
        let over = |planes: &Vec<cspace::Plane>| {
            planes.iter().map(|p| p.signed_distance(outside) + self.tolerance).fold(f64::NEG_INFINITY, f64::max)
        };
        self.over_face[piece][face.index()].iter().map(over).fold(f64::INFINITY, f64::min)
    }

    /// See [`Seams::is_felt_at_vertex`].
    pub fn margin_at_vertex(&self, piece: usize, vertex: VertexId, normal: DVec3) -> Margin {
        let point = self.pieces[piece].vertex(vertex);
        let others = self.at_vertex[piece][vertex.index()].iter();
        others.map(|other| self.margin_of(*other, point, normal)).fold(Margin::ANYWHERE, Margin::and)
    }

    /// See [`Seams::is_felt_on_edge`].
    pub fn margin_on_edge(&self, piece: usize, edge: EdgeId, point: impl FnOnce() -> DVec3, normal: DVec3) -> Margin {
        let stretches = &self.at_edge[piece][edge.index()];
        if stretches.is_empty() {
            return Margin::ANYWHERE;
        }
        let (p, point) = (&self.pieces[piece], point());
        let along = p.edge_direction(edge).dot(point - p.vertex(p.edge(edge).vertices[0]));
        let margins = stretches.iter().map(|s| {
            let to_end = (along - s.from).abs().min((along - s.to).abs());
            if !(s.from <= along && along <= s.to) {
                return Margin { way: to_end, ..Margin::ANYWHERE };
            }
            let supported = self.margin_of(s.other, point, normal);
            if supported.felt { supported } else { Margin { way: to_end, ..supported } }
        });
        margins.fold(Margin::ANYWHERE, Margin::and)
    }

    /// Whether the plane supports the piece: see [`Seams::supports`]. Along the plane the point may be anywhere.
    fn margin_of(&self, piece: u32, point: DVec3, normal: DVec3) -> Margin {
        let (q, highest) = self.piece_below(piece, point, normal);
        let (mut least, mut farthest) = (f64::INFINITY, 0.0_f64);
        for v in q.corner_ids().map(|v| q.vertex(v)) {
            least = least.min(highest - normal.dot(v));
            farthest = farthest.max(v.distance_squared(point));
        }
        Margin { felt: least >= 0.0, way: f64::INFINITY, turn: least.abs() / farthest.sqrt() }
    }
}
