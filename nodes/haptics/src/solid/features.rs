//! The vertices and edges at the features of a contact.

use cspace::{BasicContact, EdgeId, Polyhedron, VertexId};

/// Three vertices of A at a contact's features, some of them twice.
pub(crate) fn vertices_of_a(a: &Polyhedron, c: &BasicContact) -> [VertexId; 3] {
    match *c {
        BasicContact::TypeA { face_a, .. } => three_of(a.face_vertices(face_a)),
        BasicContact::TypeB { vertex_a, .. } => [vertex_a; 3],
        BasicContact::TypeC { edge_a, .. } => three_of(&a.edge(edge_a).vertices),
    }
}

/// The same of B.
pub(crate) fn vertices_of_b(b: &Polyhedron, c: &BasicContact) -> [VertexId; 3] {
    match *c {
        BasicContact::TypeA { vertex_b, .. } => [vertex_b; 3],
        BasicContact::TypeB { face_b, .. } => three_of(b.face_vertices(face_b)),
        BasicContact::TypeC { edge_b, .. } => three_of(&b.edge(edge_b).vertices),
    }
}

/// Three of at least two, as far around the ring as it goes.
fn three_of(ring: &[VertexId]) -> [VertexId; 3] {
    [ring[0], ring[ring.len() / 2], ring[ring.len() - 1]]
}

/// The edges of A at a contact's features, or beside its edge.
pub(crate) fn edges_of_a<'a>(a: &'a Polyhedron, c: &BasicContact) -> &'a [EdgeId] {
    match *c {
        BasicContact::TypeA { face_a, .. } => a.face_edges(face_a),
        BasicContact::TypeB { vertex_a, .. } => a.vertex_edges(vertex_a),
        BasicContact::TypeC { edge_a, .. } => a.edge_edges(edge_a),
    }
}

/// The same of B.
pub(crate) fn edges_of_b<'b>(b: &'b Polyhedron, c: &BasicContact) -> &'b [EdgeId] {
    match *c {
        BasicContact::TypeA { vertex_b, .. } => b.vertex_edges(vertex_b),
        BasicContact::TypeB { face_b, .. } => b.face_edges(face_b),
        BasicContact::TypeC { edge_b, .. } => b.edge_edges(edge_b),
    }
}
