use crate::c_face::{type_a, type_b, type_c};
use crate::placed::{At, Placed};
use crate::{BasicContact, Body, Polyhedron};
use spatial::Pose;

/// The graph of a C-obstacle (paper, section II.A and appendix). It is never stored: a node's neighbours follow from
/// the two polyhedra's own adjacency, so memory is O(|A| + |B|).
#[derive(Clone, Debug)]
pub struct ContactGraph<'a> {
    a: &'a Polyhedron,
    b: &'a Polyhedron,
    bodies: (Body, Body),
}

impl<'a> ContactGraph<'a> {
    /// The graph of all basic contacts between A and B.
    #[must_use]
    pub fn new(a: &'a Polyhedron, b: &'a Polyhedron) -> Self {
        Self { a, b, bodies: (Body::new(a, true), Body::new(b, false)) }
    }

    /// `|F_A||V_B| + |V_A||F_B| + |E_A||E_B|`.
    #[must_use]
    pub fn node_count(&self) -> usize {
        let (va, vb) = (self.a.corner_ids().count(), self.b.corner_ids().count());
        self.a.face_count() * vb + va * self.b.face_count() + self.a.edge_count() * self.b.edge_count()
    }

    /// Every node: types A, B, then C.
    pub fn nodes(&self) -> impl Iterator<Item = BasicContact> + '_ {
        let (a, b) = (self.a, self.b);
        let type_a = a.faces().flat_map(move |f| b.corner_ids().map(move |v| type_a(f.0, v.0)));
        let type_b = a.corner_ids().flat_map(move |v| b.faces().map(move |f| type_b(v.0, f.0)));
        let type_c = a.edges().flat_map(move |e| b.edges().map(move |g| type_c(e.0, g.0)));
        type_a.chain(type_b).chain(type_c)
    }

    /// The G-neighbours of a node at any orientation: the appendix's arcs, followed from both of their ends.
    #[must_use]
    pub fn neighbors(&self, contact: BasicContact) -> Vec<BasicContact> {
        let (a, b) = (self.a, self.b);
        let mut out = Vec::new();
        match contact {
            BasicContact::TypeA { face_a: f, vertex_b: v } => {
                out.extend(a.face_faces(f).iter().map(|g| type_a(g.0, v.0)));
                out.extend(b.vertex_vertices(v).iter().map(|w| type_a(f.0, w.0)));
                out.extend(pairs(a.face_vertices(f), b.vertex_faces(v)).map(|(w, g)| type_b(w.0, g.0)));
                out.extend(pairs(a.face_edges(f), b.vertex_edges(v)).map(|(e, g)| type_c(e.0, g.0)));
            }
            BasicContact::TypeB { vertex_a: v, face_b: f } => {
                out.extend(a.vertex_vertices(v).iter().map(|w| type_b(w.0, f.0)));
                out.extend(b.face_faces(f).iter().map(|g| type_b(v.0, g.0)));
                out.extend(pairs(a.vertex_faces(v), b.face_vertices(f)).map(|(g, w)| type_a(g.0, w.0)));
                out.extend(pairs(a.vertex_edges(v), b.face_edges(f)).map(|(e, g)| type_c(e.0, g.0)));
            }
            BasicContact::TypeC { edge_a: e, edge_b: g } => {
                out.extend(b.edge_edges(g).iter().map(|h| type_c(e.0, h.0)));
                out.extend(a.edge_edges(e).iter().map(|h| type_c(h.0, g.0)));
                let (p, q) = (a.edge(e), b.edge(g));
                out.extend(pairs(&p.faces, &q.vertices).map(|(f, v)| type_a(f.0, v.0)));
                out.extend(pairs(&p.vertices, &q.faces).map(|(v, f)| type_b(v.0, f.0)));
            }
        }
        out
    }

    /// The C-faces that share an edge with the C-face of `contact` on the C-obstacle at this pose's orientation; empty
    /// if `contact` is not applicable there. Ties are broken the same way everywhere.
    #[must_use]
    pub fn facet_neighbors(&self, contact: BasicContact, pose: &Pose) -> Vec<BasicContact> {
        let at = At::new(&self.bodies.0, pose);
        let placed = Placed::new(&self.bodies.0, &self.bodies.1, &at);
        let mut out = Vec::new();
        if placed.holds(contact) {
            placed.each_neighbor(contact, |n| out.push(n));
        }
        out
    }
}

fn pairs<S: Copy, T: Copy>(s: &[S], t: &[T]) -> impl Iterator<Item = (S, T)> {
    s.iter().flat_map(move |&x| t.iter().map(move |&y| (x, y)))
}
