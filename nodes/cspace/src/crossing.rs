use crate::body::{Spoke, TIE_BREAK};
use crate::placed::Placed;
use spatial::DVec3;

/// The Gauss arcs of a type-C node, which cross in its normal; all in W.
pub(crate) struct Crossing {
    /// The node's outward unit normal.
    pub normal: DVec3,
    /// `-R n` of A's two faces.
    pub arc_a: [DVec3; 2],
    /// Which end of `arc_a` lies on the side of B's second vertex.
    pub a_at_b1: usize,
    /// Which end of B's arc lies on the side of A's second vertex.
    pub b_at_a1: usize,
    /// Direction of A's edge with the tie break: its side of parallel edges is never a matter of rounding.
    pub dir_a: DVec3,
    /// Angle that A may turn before the arcs cease to cross, radians; 0 where a tie break decides.
    pub steady: f64,
}

impl Crossing {
    /// Which end of A's arc lies on the side of an end of B's edge.
    #[inline]
    pub(crate) fn arc_at_b(&self, end: usize) -> usize {
        if end == 1 { self.a_at_b1 } else { 1 - self.a_at_b1 }
    }

    /// Which end of B's arc lies on the side of an end of A's edge.
    #[inline]
    pub(crate) fn arc_at_a(&self, end: usize) -> usize {
        if end == 1 { self.b_at_a1 } else { 1 - self.b_at_a1 }
    }
}

impl Placed<'_> {
    /// Whether two edges' Gauss arcs surely cross, whatever the tie break says, in a multiple of `normal`, if B's faces' normals lie
    /// on both sides of A's edge by `p`: see [`Placed::crossing`].
    #[inline]
    pub(crate) fn surely_cross(&self, edge_a: u32, edge_b: u32, p: [f64; 2], normal: DVec3) -> bool {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let (v, n) = (self.turn_to_a(rod_b.dir), self.turn_to_a(normal));
        let m = rod_a.faces.map(|f| self.a.planes[f as usize].0);
        let q = m.map(|m| m.dot(v));
        let least = p[0].abs().min(p[1].abs()).min(q[0].abs()).min(q[1].abs());
        p[0] * p[1] < 0.0
            && q[0] * q[1] < 0.0
            && least > 10.0 * TIE_BREAK
            && n.dot(m[0]) * q[1].abs() + n.dot(m[1]) * q[0].abs() < 0.0
    }

    /// The crossing of the two edges' Gauss arcs, if they cross at this orientation.
    #[inline]
    pub(crate) fn crossing(&self, edge_a: u32, edge_b: u32) -> Option<Crossing> {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let n = rod_b.faces.map(|f| self.b.planes[f as usize].0);
        let dir_a = self.turn_to_w(rod_a.dir_turned);
        let p = n.map(|n| n.dot(dir_a));
        let arc_a = rod_a.faces.map(|f| -self.turn_to_w(self.a.normals_turned[f as usize]));
        let q = arc_a.map(|m| m.dot(rod_b.dir));
        if !(p[0] * p[1] < 0.0 && q[0] * q[1] < 0.0) {
            return None;
        }
        let m = arc_a[0] * q[1].abs() + arc_a[1] * q[0].abs();
        let mut normal = n[0] * p[1].abs() + n[1] * p[0].abs();
        if !(normal.dot(m) > 0.0) {
            return None;
        }
        // The tie break decides, the true directions give the plane: but not where they are parallel.
        let mut steady = 0.0;
        if let Some(straight) = true_normal(n, self.turn_to_w(rod_a.dir)) {
            normal = straight;
            steady = p[0].abs().min(p[1].abs()).min(q[0].abs()).min(q[1].abs());
        }
        let a_at_b1 = usize::from(q[1] > 0.0);
        let b_at_a1 = usize::from(p[1] < 0.0);
        Some(Crossing { normal: normal.normalize(), arc_a, a_at_b1, b_at_a1, dir_a, steady })
    }
}

/// A multiple of the normal of the plane along the edge between B's faces with normals `n` and A's edge along `u`; none
/// if the edges are nearly parallel or A's does not pass between the faces.
#[inline]
pub(crate) fn true_normal(n: [DVec3; 2], u: DVec3) -> Option<DVec3> {
    normal_between(n, n.map(|n| n.dot(u)))
}

/// The same where the normals lie on both sides of A's edge by `p`.
#[inline]
pub(crate) fn normal_between(n: [DVec3; 2], p: [f64; 2]) -> Option<DVec3> {
    (p[0] * p[1] < 0.0 && (p[0] - p[1]).abs() > 1e-9).then(|| n[0] * p[1].abs() + n[1] * p[0].abs())
}

/// The first spoke that an arc from `m0` to `m1` crosses on its way out of a vertex' cell `{m : m . to >= 0}`, and how
/// far along it does; edge `skip` is left out.
#[inline]
pub(crate) fn first_crossing(spokes: &[Spoke], m0: DVec3, m1: DVec3, skip: u32) -> Option<(u32, f64)> {
    let mut best: Option<(u32, f64)> = None;
    for s in spokes {
        let g1 = m1.dot(s.to);
        if g1 < 0.0 && s.edge != skip {
            let g0 = m0.dot(s.to).max(0.0);
            let t = g0 / (g0 - g1);
            if best.is_none_or(|(_, u)| t < u) {
                best = Some((s.edge, t));
            }
        }
    }
    best
}
