//! The look around a C-face: which of its neighbours could have a larger signed distance?
//!
//! A neighbour has exactly if `s + e tan(t/2) > 0`, with `e` the depth of `x` under the present plane, `s` how far its
//! projection lies beyond the side and `t` the angle between the planes: one test without cancellation for sharp
//! edges, flat ones and coplanar C-faces alike.

use crate::BasicContact;
use crate::crossing::Crossing;
use crate::parallelogram::Parallelogram;
use crate::placed::Placed;
use spatial::DVec3;

/// What the sides of a C-face say.
pub(crate) struct Sides {
    /// Signed distance of `x` to the plane, metres.
    pub distance: f64,
    /// Distance of x's projection to the nearest side of the C-face, metres; `< 0` beyond it.
    pub inside: f64,
    /// See [`crate::walk::Found`].
    pub steady: f64,
    /// See [`crate::walk::Found`].
    pub known: f64,
    /// See [`crate::walk::Found`].
    pub tan_half: f64,
}

/// The best way on from a node.
pub(crate) struct Best {
    key: f64,
    pub node: Option<BasicContact>,
}

impl Best {
    pub(crate) const NONE: Self = Self { key: 0.0, node: None };

    /// Takes the neighbour with normal `m` across a side if it is better than this plane and than what was offered.
    #[inline]
    pub(crate) fn offer(&mut self, s: f64, e: f64, n: DVec3, m: DVec3, eps: f64, node: BasicContact) {
        let tan_half = ((m - n).length_squared() / (m + n).length_squared().max(1e-300)).sqrt();
        let win = s + e * tan_half;
        if win > eps {
            // The gain in distance is win * sin t; the small constant lets the farthest coplanar side win a tie.
            let key = win * (2.0 * tan_half / (1.0 + tan_half * tan_half) + 1e-9);
            if key > self.key {
                self.key = key;
                self.node = Some(node);
            }
        }
    }
}

impl Placed<'_> {
    /// A vertex of one body over a face of the other: type B, or type A if `OF_A`. `p` is the vertex in the face's
    /// frame. How far A may turn is not known here.
    #[inline]
    pub(crate) fn vertex_face<const OF_A: bool>(
        &self,
        vertex: u32,
        face: u32,
        p: DVec3,
        best: &mut Best,
        planes: &mut u32,
    ) -> Sides {
        let eps = self.eps();
        let body = if OF_A { self.a } else { self.b };
        let (n, d) = body.planes[face as usize];
        let distance = n.dot(p) - d;
        let (e, under) = (-distance, (-distance).max(0.0));
        let mut nearest = f64::NEG_INFINITY;
        for side in body.sides(face) {
            let s = side.out.dot(p) - side.offset;
            nearest = nearest.max(s);
            // The neighbour is at most the whole dihedral angle away: most sides need no look at it.
            if s + under * side.tan_half > eps {
                *planes += 1;
                let (next, m) = self.across_face_side::<OF_A>(vertex, face, side.edge, side.face);
                best.offer(s, e, body.normals_turned[face as usize], m, eps, next);
            }
        }
        Sides { distance, inside: -nearest, steady: 0.0, known: f64::INFINITY, tan_half: 0.0 }
    }

    /// Two edges whose arcs cross.
    #[inline]
    pub(crate) fn edge_edge(&self, edge_a: u32, edge_b: u32, c: &Crossing, best: &mut Best, planes: &mut u32) -> Sides {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let (n, eps) = (c.normal, self.eps());
        let w = self.between_edges(edge_a, edge_b);
        let distance = n.dot(w);
        let (e, under) = (-distance, (-distance).max(0.0));
        let face = Parallelogram::new(n, w, (c.dir_a, rod_a.length), (rod_b.dir, rod_b.length));
        // The ends of the arcs that the sides stand for.
        let face_b = |end: usize| rod_b.faces[c.arc_at_a(end)] as usize;
        let cosines_b = [0, 1].map(|end| n.dot(c.arc_a[c.arc_at_b(end)]));
        let cosines_a = [n.dot(self.b.planes[face_b(0)].0), n.dot(self.b.planes[face_b(1)].0)];
        for end in 0..2 {
            let (s, cosine) = (face.beyond_b[end], cosines_b[end]);
            if may_win(s, under, cosine, eps) {
                *planes += 1;
                let (next, m) = self.across_at_b(edge_a, edge_b, end, n, c.arc_at_b(end));
                best.offer(s, e, n, m, eps, next);
            }
            let (s, cosine) = (face.beyond_a[end], cosines_a[end]);
            if may_win(s, under, cosine, eps) {
                *planes += 1;
                let (next, m) = self.across_at_a(edge_a, edge_b, end, n, c.arc_at_a(end));
                best.offer(s, e, n, m, eps, next);
            }
        }
        // When A turns by a small angle, the normal turns by at most 1.4 / sine times that, an arc's end by that itself.
        let turn = 1.0 + 1.4 / face.sine;
        // So far that it will not matter before x comes near to a side.
        let inside = -face.outermost();
        let known = (0.3 * inside / (under * turn)).max(c.steady).min(0.03 * face.sine);
        let more = 0.55 * turn * known;
        let least = cosines_a[0].min(cosines_a[1]).min(cosines_b[0].min(cosines_b[1]));
        let tan_half = ((1.0 - least) / (1.0 + least)).max(0.0).sqrt();
        let tan_half = if tan_half * more < 1.0 { (tan_half + more) / (1.0 - tan_half * more) } else { f64::INFINITY };
        Sides { distance, inside, steady: c.steady.min(known), known, tan_half }
    }
}

/// Whether a neighbour between here and the end of the arc (cosine of the angle to it) could be better.
#[inline]
pub(crate) fn may_win(s: f64, under: f64, cosine: f64, eps: f64) -> bool {
    s > eps || (under > 0.0 && under * under * (1.0 - cosine) >= (s - eps) * (s - eps) * (1.0 + cosine))
}
