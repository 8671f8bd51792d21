//! What lies across the sides of a C-face.
//!
//! The facets' normals are the nodes of two overlaid subdivisions of the Gauss sphere: B's, and A's turned and
//! reflected. Across a side of a C-face lies the first thing met on the Gauss arc that the side stands for: an arc of
//! the other body, or the arc's own end.

use crate::BasicContact;
use crate::c_face::{type_a, type_b, type_c};
use crate::crossing::first_crossing;
use crate::ids::NO_EDGE;
use crate::placed::Placed;
use spatial::DVec3;

impl Placed<'_> {
    /// The C-face across one side of a type-B (type-A if `OF_A`) C-face, and its normal in the face's frame.
    #[inline]
    pub(crate) fn across_face_side<const OF_A: bool>(
        &self,
        vertex: u32,
        face: u32,
        edge: u32,
        to: u32,
    ) -> (BasicContact, DVec3) {
        let (body, other) = if OF_A { (self.a, self.b) } else { (self.b, self.a) };
        let (n0, n1) = (body.normals_turned[face as usize], body.normals_turned[to as usize]);
        let map = |n| if OF_A { self.turn_to_w(n) } else { self.turn_to_a(n) };
        match first_crossing(other.spokes(vertex), map(n0), map(n1), NO_EDGE) {
            None if OF_A => (type_a(to, vertex), n1),
            None => (type_b(vertex, to), n1),
            Some((e, t)) => {
                let m = (n0 + (n1 - n0) * t).normalize();
                (if OF_A { type_c(edge, e) } else { type_c(e, edge) }, m)
            }
        }
    }

    /// Across the side of a type-C C-face with this normal at an end of B's edge: along A's arc to `arc_end`, in the cell of that
    /// vertex of B.
    pub(crate) fn across_at_b(
        &self,
        edge_a: u32,
        edge_b: u32,
        end: usize,
        normal: DVec3,
        arc_end: usize,
    ) -> (BasicContact, DVec3) {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let (vertex, face) = (rod_b.vertices[end], rod_a.faces[arc_end]);
        let target = -self.turn_to_w(self.a.normals_turned[face as usize]);
        match first_crossing(self.b.spokes(vertex), -normal, -target, edge_b) {
            None => (type_a(face, vertex), target),
            Some((e, t)) => (type_c(edge_a, e), (normal + (target - normal) * t).normalize()),
        }
    }

    /// Across the side at an end of A's edge: along B's arc, in the cell of that vertex of A.
    pub(crate) fn across_at_a(
        &self,
        edge_a: u32,
        edge_b: u32,
        end: usize,
        normal: DVec3,
        arc_end: usize,
    ) -> (BasicContact, DVec3) {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let (vertex, face) = (rod_a.vertices[end], rod_b.faces[arc_end]);
        let target = self.b.planes[face as usize].0;
        match first_crossing(self.a.spokes(vertex), self.turn_to_a(normal), self.turn_to_a(target), edge_a) {
            None => (type_b(vertex, face), target),
            Some((e, t)) => (type_c(e, edge_b), (normal + (target - normal) * t).normalize()),
        }
    }

    /// Which end of A's arc lies on the side of an end of B's edge, where the two edges' arcs cross.
    pub(crate) fn arc_at_b(&self, edge_a: u32, edge_b: u32, end: usize) -> usize {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let second = self.turn_to_w(self.a.normals_turned[rod_a.faces[1] as usize]).dot(rod_b.dir) < 0.0;
        usize::from(second == (end == 1))
    }

    /// Which end of B's arc lies on the side of an end of A's edge.
    pub(crate) fn arc_at_a(&self, edge_a: u32, edge_b: u32, end: usize) -> usize {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let second = self.b.planes[rod_b.faces[1] as usize].0.dot(self.turn_to_w(rod_a.dir_turned)) < 0.0;
        usize::from(second == (end == 1))
    }

    /// Hands over the C-faces across every side of an applicable node.
    pub(crate) fn each_neighbor(&self, node: BasicContact, mut found: impl FnMut(BasicContact)) {
        match node {
            BasicContact::TypeB { vertex_a: v, face_b: f } => {
                for side in self.b.sides(f.0) {
                    found(self.across_face_side::<false>(v.0, f.0, side.edge, side.face).0);
                }
            }
            BasicContact::TypeA { face_a: f, vertex_b: v } => {
                for side in self.a.sides(f.0) {
                    found(self.across_face_side::<true>(v.0, f.0, side.edge, side.face).0);
                }
            }
            BasicContact::TypeC { edge_a: e, edge_b: g } => {
                if let Some(c) = self.crossing(e.0, g.0) {
                    for end in 0..2 {
                        found(self.across_at_b(e.0, g.0, end, c.normal, c.arc_at_b(end)).0);
                        found(self.across_at_a(e.0, g.0, end, c.normal, c.arc_at_a(end)).0);
                    }
                }
            }
        }
    }
}
