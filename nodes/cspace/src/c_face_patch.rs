use crate::c_face_polygon::{Facet, Sum};
use crate::placed::{At, Placed};
use crate::{ActivePair, BasicContact, Body, BodyTracker, CFacePolygon, Polyhedron, Tracker};
use spatial::Pose;
use std::collections::{BTreeSet, VecDeque};

/// Nodes of the graph that are looked at for each face wanted: where C-faces are coplanar, many nodes are one face.
const NODES_PER_FACE: usize = 16;

impl Tracker {
    /// The faces of the C-obstacle around Near at the orientation of `pose`, the last one that was tracked: at most `most`
    /// of them, taken from Near outward step by step along the applicability subgraph (paper, section II.A). They are
    /// the same polygons as [`crate::c_face_polygons`] makes, all of them if `most` allows.
    ///
    /// Cost `O(|A| + |B| + most log most)`, where the first two are a multiplication for each vertex; allocates: for
    /// pictures and messages, never for the tick. Empty before the first step.
    #[must_use]
    pub fn polygons_around_near(&self, pose: &Pose, most: usize) -> Vec<CFacePolygon> {
        let Some(near) = self.near() else { return Vec::new() };
        polygons_around(near, self.bodies(), (self.moving(), self.fixed()), pose, most)
    }
}

impl BodyTracker {
    /// [`Tracker::polygons_around_near`] of a pair of the last step, at that step's `pose`.
    #[must_use]
    pub fn polygons_around_near(&self, pair: &ActivePair, pose: &Pose, most: usize) -> Vec<CFacePolygon> {
        let world = self.world();
        let polyhedra = (&*world.moving[pair.part as usize], &*world.fixed[pair.piece as usize].polyhedron);
        polygons_around(pair.tracked.near.contact, self.bodies(pair), polyhedra, pose, most)
    }
}

fn polygons_around(
    near: BasicContact,
    (body_a, body_b): (&Body, &Body),
    (a, b): (&Polyhedron, &Polyhedron),
    pose: &Pose,
    most: usize,
) -> Vec<CFacePolygon> {
    let at = At::new(body_a, pose);
    let placed = Placed::new(body_a, body_b, &at);
    let sum = Sum::new(a, b, pose.rotation);
    let mut facets: Vec<Facet> = Vec::new();
    let mut known = BTreeSet::new();
    let mut seen = BTreeSet::from([near]);
    let mut queue = VecDeque::from([near]);
    while let Some(node) = queue.pop_front() {
        let (vertex_a, vertex_b) = supporting_vertices(a, b, node);
        let facet = sum.facet_at(placed.plane(node).normal_w, vertex_a, vertex_b);
        // Between parallel edges the graph has nodes of no area, which tie coplanar C-faces together.
        if !known.contains(&facet.supports()) && sum.spans_face(&facet) {
            if facets.len() == most {
                break;
            }
            known.insert(facet.supports());
            facets.push(facet);
        }
        placed.each_neighbor(node, |next: BasicContact| {
            if seen.len() < most.saturating_mul(NODES_PER_FACE) && seen.insert(next) {
                queue.push_back(next);
            }
        });
    }
    sum.polygons_of(facets)
}

/// A vertex of A and one of B that support the two bodies along the node's normal.
fn supporting_vertices(a: &Polyhedron, b: &Polyhedron, node: BasicContact) -> (u32, u32) {
    match node {
        BasicContact::TypeA { face_a, vertex_b } => (a.face_vertices(face_a)[0].0, vertex_b.0),
        BasicContact::TypeB { vertex_a, face_b } => (vertex_a.0, b.face_vertices(face_b)[0].0),
        BasicContact::TypeC { edge_a, edge_b } => (a.edge(edge_a).vertices[0].0, b.edge(edge_b).vertices[0].0),
    }
}
