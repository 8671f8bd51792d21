//! The walk over the facets of the C-obstacle at the present orientation.

use crate::c_face::{type_a, type_b};
use crate::placed::Placed;
use crate::sides::{Best, Sides};
use crate::{BasicContact, CFace};

/// Where a walk ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub face: CFace,
    /// Distance of x's projection to the nearest side of the C-face, metres; `< 0` beyond it.
    pub inside: f64,
    /// Whether no neighbour is better; false if the bound was reached first.
    pub settled: bool,
    /// Angle that A may turn by from here while the node surely stays applicable, radians; `<= 0` if not known.
    pub steady: f64,
    /// Angle that A may turn by from here while what is said of neighbours holds, radians.
    pub known: f64,
    /// Of two edges: tangent of half the angle that no neighbour's normal lies beyond, meanwhile.
    pub tan_half: f64,
}

impl Found {
    /// A node that a walk could not make sure of.
    fn lost(face: CFace) -> Self {
        Self { face, inside: f64::NEG_INFINITY, settled: false, steady: 0.0, known: 0.0, tan_half: 0.0 }
    }
}

impl Placed<'_> {
    /// Climbs from `node` to a C-face none of whose neighbours has a larger signed distance, in at most `limit` moves.
    /// `holds`: whether `node` is known to be applicable. `planes` counts the planes looked at.
    pub(crate) fn settle(&self, node: BasicContact, holds: bool, limit: u32, planes: &mut u32) -> Found {
        // Whether edges still cross comes out with their plane.
        let mut node = node;
        let mut lead = None;
        if !holds && !matches!(node, BasicContact::TypeC { .. }) {
            let (first, steady) = self.repair(node, planes);
            (node, lead) = (first, Some(steady));
        }
        let mut moves = 0;
        loop {
            *planes += 1;
            let mut best = Best::NONE;
            let (normal_w, sides) = match node {
                BasicContact::TypeB { vertex_a: v, face_b: f } => {
                    let p = self.point_in_w(self.a.points[v.index()]);
                    let sides = self.vertex_face::<false>(v.0, f.0, p, &mut best, planes);
                    (self.b.planes[f.index()].0, sides)
                }
                BasicContact::TypeA { face_a: f, vertex_b: v } => {
                    let q = self.point_in_a(self.b.points[v.index()]);
                    let sides = self.vertex_face::<true>(v.0, f.0, q, &mut best, planes);
                    (-self.turn_to_w(self.a.planes[f.index()].0), sides)
                }
                BasicContact::TypeC { edge_a, edge_b } => match self.crossing(edge_a.0, edge_b.0) {
                    Some(c) => (c.normal, self.edge_edge(edge_a.0, edge_b.0, &c, &mut best, planes)),
                    None => {
                        moves += 1;
                        let (next, steady) = self.repair(node, planes);
                        (node, lead) = (next, Some(steady));
                        if moves < limit {
                            continue;
                        }
                        // Out of moves: what repair gave is applicable and its plane is true.
                        return Found::lost(self.plane(node));
                    }
                },
            };
            moves += 1;
            match best.node {
                Some(next) if moves < limit => (node, lead) = (next, None),
                next => {
                    let Sides { distance, inside, mut steady, known, tan_half } = sides;
                    if !matches!(node, BasicContact::TypeC { .. }) {
                        steady = lead.unwrap_or_else(|| self.lead(node));
                    }
                    let face = CFace { contact: node, normal_w, distance };
                    return Found { face, inside, settled: next.is_none(), steady, known, tan_half };
                }
            }
        }
    }

    /// A node that can take place at this orientation, near `node`, and the angle that A may turn before it cannot
    /// (for vertex and face).
    #[inline]
    fn repair(&self, node: BasicContact, planes: &mut u32) -> (BasicContact, f64) {
        match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let m = self.turn_to_a(self.b.normals_turned[face_b.index()]);
                let (v, steady) = self.a.lowest_and_lead(m, vertex_a.0, planes);
                (type_b(v, face_b.0), steady)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let m = self.turn_to_w(self.a.normals_turned[face_a.index()]);
                let (v, steady) = self.b.lowest_and_lead(m, vertex_b.0, planes);
                (type_a(face_a.0, v), steady)
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                if self.crossing(edge_a.0, edge_b.0).is_some() {
                    return (node, 0.0);
                }
                let (rod_a, rod_b) = (&self.a.rods[edge_a.index()], &self.b.rods[edge_b.index()]);
                let u = self.turn_to_w(rod_a.dir_turned);
                let off = rod_b.faces.map(|f| self.b.planes[f as usize].0.dot(u).abs());
                let f = rod_b.faces[usize::from(off[1] < off[0])];
                let m = self.turn_to_a(self.b.normals_turned[f as usize]);
                let (v, steady) = self.a.lowest_and_lead(m, rod_a.vertices[0], planes);
                (type_b(v, f), steady)
            }
        }
    }

    /// The angle that A may turn before an applicable node of vertex and face ceases to be; `<= 0` if it is none.
    pub(crate) fn lead(&self, node: BasicContact) -> f64 {
        let (same, steady) = self.repair(node, &mut 0);
        if same == node { steady } else { 0.0 }
    }

    /// Whether the node is applicable, ties broken.
    pub(crate) fn holds(&self, node: BasicContact) -> bool {
        match node {
            BasicContact::TypeC { edge_a, edge_b } => self.crossing(edge_a.0, edge_b.0).is_some(),
            _ => self.repair(node, &mut 0).0 == node,
        }
    }
}
