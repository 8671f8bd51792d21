//! The two assemblies in contact, with their seams.

use crate::solid::gaps::closed;
use crate::solid::seams::Seams;
use crate::solid::sharpness::Sharpness;
use crate::solid::{Cover, Placed};
use cspace::{BasicContact, FaceId, Polyhedron, World};
use spatial::DVec3;
use std::sync::Arc;

/// The world, narrow gaps between pieces closed, with the seams of both sides.
#[derive(Clone, Debug)]
pub(crate) struct Solids {
    pub world: Arc<World>,
    pub moving: Seams,
    pub fixed: Seams,
    /// Whether either has an obtuse hollow joint anywhere.
    pub is_hollow: bool,
    /// Radius of a ball that holds A, metres: whatever pieces it is cut into.
    pub size: f64,
    /// Of the parts and of the pieces.
    sharp_moving: Vec<Sharpness>,
    sharp_fixed: Vec<Sharpness>,
}

impl Solids {
    pub fn new(world: Arc<World>) -> Self {
        let world = closed(world);
        let moving = Seams::new(world.moving.clone());
        let fixed = Seams::new(world.fixed.iter().map(|p| p.polyhedron.clone()).collect());
        let is_hollow = moving.has_hollow() || fixed.has_hollow();
        let sharp_moving = world.moving.iter().map(|p| Sharpness::of(p)).collect();
        let sharp_fixed = world.fixed.iter().map(|p| Sharpness::of(&p.polyhedron)).collect();
        let size = half_extent(&world.moving);
        Self { world, moving, fixed, is_hollow, size, sharp_moving, sharp_fixed }
    }

    pub fn part(&self, part: usize) -> &Polyhedron {
        &self.world.moving[part]
    }

    pub fn piece(&self, piece: usize) -> &Polyhedron {
        &self.world.fixed[piece].polyhedron
    }

    /// Farthest point of A from its origin, metres.
    pub fn lever(&self) -> f64 {
        self.world.moving.iter().flat_map(|p| p.corner_ids().map(|v| p.vertex(v).length())).fold(0.0, f64::max)
    }

    /// Whether both sides of the pair are uncut bodies: then every contact is felt.
    pub fn is_seamless(&self, part: usize, piece: usize) -> bool {
        self.moving.is_alone(part) && self.fixed.is_alone(piece)
    }

    /// Whether the face of A, or of the piece, lies wholly inside its own assembly.
    pub fn is_internal_a(&self, part: usize, face: FaceId) -> bool {
        self.moving.cover(part, face) == Cover::Internal
    }

    /// See [`Solids::is_internal_a`].
    pub fn is_internal_b(&self, piece: usize, face: FaceId) -> bool {
        self.fixed.cover(piece, face) == Cover::Internal
    }

    /// How much of a contact a basic contact is, 0 to 1: a vertex by its own sharpness, a crossing by that of the blunter edge.
    pub fn sharpness(&self, part: usize, piece: usize, contact: BasicContact) -> f32 {
        let (a, b) = (&self.sharp_moving[part], &self.sharp_fixed[piece]);
        match contact {
            BasicContact::TypeA { vertex_b, .. } => b.of_vertex(vertex_b),
            BasicContact::TypeB { vertex_a, .. } => a.of_vertex(vertex_a),
            BasicContact::TypeC { edge_a, edge_b } => a.of_edge(edge_a).min(b.of_edge(edge_b)),
        }
    }

    /// Whether the piece's face goes on beyond its side `side` at `point_w`: see [`Seams::goes_on`].
    pub fn goes_on_b(&self, piece: usize, face: FaceId, side: usize, point_w: DVec3) -> bool {
        !self.fixed.is_alone(piece) && self.fixed.goes_on(piece, face, side, point_w)
    }

    /// The same of a part of A.
    pub fn goes_on_a(&self, part: usize, face: FaceId, side: usize, point_w: DVec3, placed: &Placed) -> bool {
        !self.moving.is_alone(part) && self.moving.goes_on(part, face, side, placed.seen_from_a(point_w))
    }

    /// The face of part `other` that is one plane with this one of `part`, which may be `other` itself.
    pub fn flush_a(&self, part: usize, face: FaceId, other: usize) -> Option<FaceId> {
        flush(&self.moving, part, face, other)
    }

    /// The same of a piece.
    pub fn flush_b(&self, piece: usize, face: FaceId, other: usize) -> Option<FaceId> {
        flush(&self.fixed, piece, face, other)
    }

    /// The same contact with the faces that are one plane with the contact's own: part, piece and contact.
    pub fn flush_contacts(
        &self,
        part: u32,
        piece: u32,
        contact: BasicContact,
    ) -> impl Iterator<Item = (u32, u32, BasicContact)> {
        let (of_a, of_b): (&[_], &[_]) = match contact {
            BasicContact::TypeA { face_a, .. } => (self.moving.flush(part as usize, face_a), &[]),
            BasicContact::TypeB { face_b, .. } => (&[], self.fixed.flush(piece as usize, face_b)),
            BasicContact::TypeC { .. } => (&[], &[]),
        };
        let with_a = move |(other, face_a): &(u32, FaceId)| match contact {
            BasicContact::TypeA { vertex_b, .. } => {
                Some((*other, piece, BasicContact::TypeA { face_a: *face_a, vertex_b }))
            }
            _ => None,
        };
        let with_b = move |(other, face_b): &(u32, FaceId)| match contact {
            BasicContact::TypeB { vertex_a, .. } => {
                Some((part, *other, BasicContact::TypeB { vertex_a, face_b: *face_b }))
            }
            _ => None,
        };
        of_a.iter().filter_map(with_a).chain(of_b.iter().filter_map(with_b))
    }
}

/// Half the diagonal of the box about the bodies, metres.
fn half_extent(bodies: &[Arc<Polyhedron>]) -> f64 {
    let corners = || bodies.iter().flat_map(|p| p.corner_ids().map(|v| p.vertex(v)));
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    0.5 * low.distance(high)
}

fn flush(seams: &Seams, piece: usize, face: FaceId, other: usize) -> Option<FaceId> {
    if piece == other {
        return Some(face);
    }
    seams.flush(piece, face).iter().find(|(p, _)| *p as usize == other).map(|(_, f)| *f)
}
