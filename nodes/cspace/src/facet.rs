//! The facet of the C-obstacle that Near's C-face is a part of.
//!
//! The facet with the outward normal `n` is the Minkowski sum of what touches a plane with that normal: of B, and of A reflected.
//! It has one C-face where one of the two is a vertex, or both are edges that cross. Where a face of the one lies flat on an edge
//! or a face of the other, several C-faces share it: they lie in one plane, and only the tie break tells which place of the facet
//! belongs to which. Then no C-face of them speaks for the facet. The walk goes on to the one that holds `x`'s projection, all of
//! whose own sides may lie within the facet or far off, while a facet across a side of another one is nearer: it would rest on a
//! plateau.
//!
//! What is better beside a facet does not depend on how it is divided. Its sides are those of B's part and of A's, each moved out
//! by the corner of the other part that lies farthest that way; `s` is counted to them, and across each lies what its Gauss arc,
//! which starts in `n`, meets first. As `e` and the plane are the same all over the facet, a facet beside it is nearer exactly if
//! `s + e tan(t/2) > 0` (see [`crate::sides`]). So with no such side the facet is a local optimum among facets, whatever
//! the ties: that is the paper's Near in the graph where coplanar C-faces are one node. Where they are coplanar but for the digits
//! of a file, this finds no less: what it finds is taken only if its plane is nearer in truth.
//!
//! It matters where the depth is not proven to be the global one; where it is, no facet at all is nearer.

use crate::body::Spoke;
use crate::c_face::{type_a, type_b, type_c};
use crate::crossing::first_crossing;
use crate::ids::NO_EDGE;
use crate::pair_state::STEP_MOVES;
use crate::placed::Placed;
use crate::sides::{Best, may_win};
use crate::walk::Found;
use crate::{BasicContact, Body, CFace, PARALLEL_ANGLE};
use spatial::DVec3;

/// What of a body touches a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Vertex(u32),
    Edge(u32),
    Face(u32),
}

impl Part {
    /// What of the body touches the plane with outward normal `m` (own frame) that its vertex `v` lies in.
    fn at(body: &Body, v: u32, m: DVec3) -> Self {
        let mut part = Self::Vertex(v);
        for spoke in body.spokes(v).iter().filter(|s| s.to.dot(m).abs() < PARALLEL_ANGLE) {
            let lies = |f: &&u32| (body.planes[**f as usize].0 - m).length_squared() < PARALLEL_ANGLE * PARALLEL_ANGLE;
            match body.rods[spoke.edge as usize].faces.iter().find(lies) {
                Some(f) => return Self::Face(*f),
                None => part = Self::Edge(spoke.edge),
            }
        }
        part
    }

    fn count(self, body: &Body) -> usize {
        match self {
            Self::Vertex(_) => 1,
            Self::Edge(_) => 2,
            Self::Face(f) => body.sides(f).len(),
        }
    }

    fn corner(self, body: &Body, i: usize) -> u32 {
        match self {
            Self::Vertex(v) => v,
            Self::Edge(e) => body.rods[e as usize].vertices[i],
            Self::Face(f) => body.sides(f)[i].corner,
        }
    }

    /// A side, as an edge and the face across it; of an edge both are its own.
    fn side(self, body: &Body, i: usize) -> Option<(u32, u32)> {
        match self {
            Self::Vertex(_) => None,
            Self::Edge(e) => Some((e, body.rods[e as usize].faces[i])),
            Self::Face(f) => body.sides(f).get(i).map(|s| (s.edge, s.face)),
        }
    }

    /// The corner that is lowest along a direction (own frame), downhill around it from the `i`-th.
    fn lowest(self, body: &Body, direction: DVec3, mut i: usize) -> usize {
        let n = self.count(body);
        let height = |i: usize| direction.dot(body.points[self.corner(body, i) as usize]);
        for _ in 0..n {
            let beside = [(i + 1) % n, (i + n - 1) % n];
            let Some(next) = beside.into_iter().find(|k| height(*k) < height(i)) else { break };
            i = next;
        }
        i
    }
}

/// The parts of the two bodies that a facet is the sum of.
#[derive(Clone, Copy)]
struct Parts {
    a: Part,
    b: Part,
}

impl Placed<'_> {
    /// A C-face beside the facet of `near` that is nearer, climbed from there; none if the facet is a local optimum.
    pub(crate) fn beyond_ties(&self, near: &Found, planes: &mut u32) -> Option<Found> {
        let next = self.beside_facet(&near.face, planes)?;
        let found = self.settle(next, false, STEP_MOVES, planes);
        (found.face.distance > near.face.distance + 2.0 * self.eps()).then_some(found)
    }

    /// The best C-face beside the facet, if that is divided and one is nearer.
    fn beside_facet(&self, near: &CFace, planes: &mut u32) -> Option<BasicContact> {
        let (a, b) = (self.a, self.b);
        let (va, vb) = match near.contact {
            BasicContact::TypeA { face_a: f, vertex_b: v } => (a.sides(f.0).first()?.corner, v.0),
            BasicContact::TypeB { vertex_a: v, face_b: f } => (v.0, b.sides(f.0).first()?.corner),
            BasicContact::TypeC { edge_a: e, edge_b: g } => {
                (a.rods[e.index()].vertices[0], b.rods[g.index()].vertices[0])
            }
        };
        let n = near.normal_w;
        let parts = Parts { a: Part::at(a, va, -self.turn_to_a(n)), b: Part::at(b, vb, n) };
        let is_divided = match (parts.a, parts.b) {
            (Part::Vertex(_), _) | (_, Part::Vertex(_)) | (Part::Edge(_), Part::Edge(_)) => false,
            (Part::Face(_), _) | (_, Part::Face(_)) => true,
        };
        if !is_divided {
            return None;
        }
        let mut best = Best::NONE;
        self.offer_beside::<false>(near, parts, &mut best, planes);
        self.offer_beside::<true>(near, parts, &mut best, planes);
        best.node
    }

    /// Offers what lies across the sides of the facet that come from B's part, or from A's if `OF_A`.
    fn offer_beside<const OF_A: bool>(&self, near: &CFace, parts: Parts, best: &mut Best, planes: &mut u32) {
        let (body, part) = if OF_A { (self.a, parts.a) } else { (self.b, parts.b) };
        let (other, part_of_other) = if OF_A { (self.b, parts.b) } else { (self.a, parts.a) };
        // The reflection of A puts the outward normals of the one into the other's frame as inward ones, and back.
        let normal_w = |m: DVec3| if OF_A { -self.turn_to_w(m) } else { m };
        let to_other = |m: DVec3| if OF_A { -m } else { self.turn_to_a(m) };
        let normal_of_other_w = |m: DVec3| if OF_A { m } else { -self.turn_to_w(m) };
        let (n, e, eps) = (near.normal_w, -near.distance, self.eps());
        let mut i = 0;
        for (edge, face) in (0..part.count(body)).filter_map(|k| part.side(body, k)) {
            let target = normal_w(body.planes[face as usize].0);
            let out = target.reject_from_normalized(n).normalize_or_zero();
            let down = to_other(out);
            i = part_of_other.lowest(other, down, i);
            let v = part_of_other.corner(other, i);
            let (on_edge, on_other) = (body.rods[edge as usize].origin, other.points[v as usize]);
            let w = if OF_A { self.point_in_w(on_edge) - on_other } else { self.point_in_w(on_other) - on_edge };
            let s = out.dot(w);
            if !may_win(s, e, n.dot(target), eps) {
                continue;
            }
            *planes += 1;
            let end = if OF_A { type_a(face, v) } else { type_b(v, face) };
            // An edge of the other along this side: both arcs run the same way, and the one that ends first tells.
            let lies_along =
                |s: &&Spoke| s.to.dot(to_other(n)).abs() < PARALLEL_ANGLE && s.to.dot(down).abs() < PARALLEL_ANGLE;
            if let Some(along) = other.spokes(v).iter().find(lies_along) {
                let faces =
                    other.rods[along.edge as usize].faces.map(|f| normal_of_other_w(other.planes[f as usize].0));
                let ends_there = faces[usize::from(faces[1].dot(out) > faces[0].dot(out))];
                if ends_there.dot(n) <= target.dot(n) {
                    best.offer(s, e, n, target, eps, end);
                }
                continue;
            }
            let (next, m) = match first_crossing(other.spokes(v), to_other(n), to_other(target), NO_EDGE) {
                None => (end, target),
                Some((g, t)) => {
                    (if OF_A { type_c(edge, g) } else { type_c(g, edge) }, (n + (target - n) * t).normalize())
                }
            };
            best.offer(s, e, n, m, eps, next);
        }
    }
}
