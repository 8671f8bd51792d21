//! The walk over the facets of the C-obstacle at the present orientation.
//!
//! The facets' normals are the nodes of two overlaid subdivisions of the Gauss sphere: B's, and A's turned and
//! reflected. Across a side of a C-face lies the first thing met on the Gauss arc that the side stands for: an arc of
//! the other body, or the arc's own end. A neighbour has the larger signed distance exactly if
//! `s + e tan(t/2) > 0`, with `e` the depth of `x` under the present plane, `s` how far its projection lies beyond
//! the side and `t` the angle between the planes: one test without cancellation for sharp edges, flat ones and
//! coplanar C-faces alike.

use crate::body::Spoke;
use crate::c_face::{type_a, type_b, type_c};
use crate::{BasicContact, Body, CFace};
use spatial::{DMat3, DVec3, Pose};

/// A pose of A, and what every pair with A needs of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At {
    pub pose: Pose,
    /// `w_from_a`.
    pub r: DMat3,
    /// A's centre in W, metres.
    pub center: DVec3,
}

impl At {
    #[inline]
    pub(crate) fn new(a: &Body, pose: &Pose) -> Self {
        let r = pose.rotation_matrix();
        Self { pose: *pose, r, center: r * a.center + pose.translation }
    }
}

/// Two bodies at a pose of A.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub a: &'a Body,
    pub b: &'a Body,
    pub x: DVec3,
    /// `w_from_a`.
    pub r: DMat3,
    /// `a_from_w`.
    pub rt: DMat3,
    /// A's centre in W, metres.
    pub center: DVec3,
    /// Length below which ties are kept as they are, metres.
    pub eps: f64,
}

/// Where a walk ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub face: CFace,
    /// Distance of x's projection to the nearest side of the C-face, metres; `< 0` beyond it.
    pub inside: f64,
    /// Whether no neighbour is better; false if the bound was reached first.
    pub settled: bool,
    /// While A's centre has moved and A has turned by so little that `|dc| + lever dtheta` stays below this, the node
    /// is applicable and no neighbour becomes better, and neither `inside` nor the distance changes by more, metres;
    /// `<= 0` if nothing is known.
    pub room: f64,
    /// What an angle that A turns by counts for, metres; at least A's radius.
    pub lever: f64,
    /// Bound of the angle by which the normal turns when A turns by a small angle, divided by that angle.
    pub normal_turn: f64,
}

impl Found {
    /// A node that a walk could not make sure of.
    fn lost(face: CFace) -> Self {
        Self { face, inside: f64::NEG_INFINITY, settled: false, room: 0.0, lever: f64::INFINITY, normal_turn: 0.0 }
    }
}

/// What the sides of a C-face say: see [`Found`].
struct Sides {
    distance: f64,
    inside: f64,
    room: f64,
    lever: f64,
    normal_turn: f64,
}

/// The best way on from a node.
struct Best {
    key: f64,
    node: Option<BasicContact>,
}

/// The first spoke that an arc from `m0` to `m1` crosses on its way out of a vertex' cell `{m : m . to >= 0}`.
#[inline]
fn first_crossing(spokes: &[Spoke], m0: DVec3, m1: DVec3, skip: u32) -> Option<(u32, f64)> {
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

const NO_EDGE: u32 = u32::MAX;

/// A type-C node's arcs, in W.
struct Crossing {
    normal: DVec3,
    /// `-R n` of A's two faces.
    arc_a: [DVec3; 2],
    /// Which end of `arc_a` lies on the side of B's second vertex.
    a_at_b1: usize,
    /// Which end of B's arc lies on the side of A's second vertex.
    b_at_a1: usize,
    /// Direction of A's edge with the tie break: its side of parallel edges is never a matter of rounding.
    dir_a: DVec3,
    /// Angle that A may turn before the arcs cease to cross; 0 where a tie break decides.
    steady: f64,
}

impl<'a> Placed<'a> {
    #[inline]
    pub(crate) fn new(a: &'a Body, b: &'a Body, pose: &Pose) -> Self {
        Self::at(a, b, &At::new(a, pose))
    }

    #[inline]
    pub(crate) fn at(a: &'a Body, b: &'a Body, at: &At) -> Self {
        let eps = 2e-13 * (a.radius + b.radius) + 1e-15 * (a.reach + b.reach);
        Self { a, b, x: at.pose.translation, r: at.r, rt: at.r.transpose(), center: at.center, eps }
    }

    /// Climbs from `node` to a C-face none of whose neighbours has a larger signed distance, in at most `limit` moves.
    /// `planes` counts the planes looked at.
    #[inline]
    pub(crate) fn settle(&self, node: BasicContact, limit: u32, planes: &mut u32) -> Found {
        // Whether edges still cross comes out with their plane.
        let (mut node, mut steady) =
            if matches!(node, BasicContact::TypeC { .. }) { (node, 0.0) } else { self.repair(node, planes) };
        let mut moves = 0;
        loop {
            *planes += 1;
            let mut best = Best { key: 0.0, node: None };
            let (normal_w, sides) = match node {
                BasicContact::TypeB { vertex_a: v, face_b: f } => {
                    let p = self.x + self.r * self.a.points[v.index()];
                    let sides = self.vertex_face::<false>(v.0, f.0, p, &mut best, planes);
                    (self.b.planes[f.index()].0, sides)
                }
                BasicContact::TypeA { face_a: f, vertex_b: v } => {
                    let q = self.rt * (self.b.points[v.index()] - self.x);
                    let sides = self.vertex_face::<true>(v.0, f.0, q, &mut best, planes);
                    (-(self.r * self.a.planes[f.index()].0), sides)
                }
                BasicContact::TypeC { edge_a, edge_b } => match self.crossing(edge_a.0, edge_b.0) {
                    Some(c) => {
                        steady = c.steady;
                        (c.normal, self.edge_edge(edge_a.0, edge_b.0, &c, &mut best, planes))
                    }
                    None => {
                        moves += 1;
                        (node, steady) = self.repair(node, planes);
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
                Some(next) if moves < limit => (node, steady) = (next, 0.0),
                next => {
                    let face = CFace { contact: node, normal_w, distance: sides.distance };
                    let Sides { inside, lever, normal_turn, .. } = sides;
                    let room = sides.room.min(steady * lever);
                    return Found { face, inside, settled: next.is_none(), room, lever, normal_turn };
                }
            }
        }
    }

    /// A node that can take place at this orientation, near `node`, and the angle that A may turn before it cannot
    /// (for vertex and face).
    #[inline]
    pub(crate) fn repair(&self, node: BasicContact, planes: &mut u32) -> (BasicContact, f64) {
        match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let m = self.rt * self.b.normals_turned[face_b.index()];
                let (v, steady) = self.a.lowest_and_lead(m, vertex_a.0, planes);
                (type_b(v, face_b.0), steady)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let m = self.r * self.a.normals_turned[face_a.index()];
                let (v, steady) = self.b.lowest_and_lead(m, vertex_b.0, planes);
                (type_a(face_a.0, v), steady)
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                if self.crossing(edge_a.0, edge_b.0).is_some() {
                    return (node, 0.0);
                }
                let (rod_a, rod_b) = (&self.a.rods[edge_a.index()], &self.b.rods[edge_b.index()]);
                let u = self.r * rod_a.dir_turned;
                let off = rod_b.faces.map(|f| self.b.planes[f as usize].0.dot(u).abs());
                let f = rod_b.faces[usize::from(off[1] < off[0])];
                let m = self.rt * self.b.normals_turned[f as usize];
                (type_b(self.a.lowest(m, rod_a.vertices[0], planes), f), 0.0)
            }
        }
    }

    /// Whether the node is applicable, ties broken.
    pub(crate) fn holds(&self, node: BasicContact) -> bool {
        match node {
            BasicContact::TypeC { edge_a, edge_b } => self.crossing(edge_a.0, edge_b.0).is_some(),
            _ => self.repair(node, &mut 0).0 == node,
        }
    }

    /// A vertex of one body over a face of the other: type B, or type A if `OF_A`. `p` is the vertex in the face's
    /// frame.
    #[inline]
    fn vertex_face<const OF_A: bool>(
        &self,
        vertex: u32,
        face: u32,
        p: DVec3,
        best: &mut Best,
        planes: &mut u32,
    ) -> Sides {
        let body = if OF_A { self.a } else { self.b };
        let (n, d) = body.planes[face as usize];
        let distance = n.dot(p) - d;
        let (e, under) = (-distance, (-distance).max(0.0));
        let mut nearest = f64::NEG_INFINITY;
        let mut room = f64::INFINITY;
        for side in body.sides(face) {
            let s = side.out.dot(p) - side.offset;
            nearest = nearest.max(s);
            // The neighbour is at most the whole dihedral angle away: most sides need no look at it.
            let lead = -(s + under * side.tan_half);
            // Both `s` and the depth change by what the vertex moves in the face's frame.
            room = room.min(lead * side.tan_share);
            if lead < -self.eps {
                *planes += 1;
                let (next, m) = self.across_face_side::<OF_A>(vertex, face, side.edge, side.face);
                best.offer(s, e, body.normals_turned[face as usize], m, self.eps, next);
            }
        }
        // A vertex of A moves as A does; a vertex of B, seen from A, may lie on a longer lever by its distance.
        let (lever, normal_turn) = if OF_A { (self.a.radius + distance.abs(), 1.0) } else { (self.a.radius, 0.0) };
        Sides { distance, inside: -nearest, room, lever, normal_turn }
    }

    /// The C-face across one side of a type-B (type-A if `OF_A`) C-face, and its normal in the face's frame.
    #[inline]
    fn across_face_side<const OF_A: bool>(&self, vertex: u32, face: u32, edge: u32, to: u32) -> (BasicContact, DVec3) {
        let (body, other, map) = if OF_A { (self.a, self.b, &self.r) } else { (self.b, self.a, &self.rt) };
        let (n0, n1) = (body.normals_turned[face as usize], body.normals_turned[to as usize]);
        match first_crossing(other.spokes(vertex), *map * n0, *map * n1, NO_EDGE) {
            None if OF_A => (type_a(to, vertex), n1),
            None => (type_b(vertex, to), n1),
            Some((e, t)) => {
                let m = (n0 + (n1 - n0) * t).normalize();
                (if OF_A { type_c(edge, e) } else { type_c(e, edge) }, m)
            }
        }
    }

    /// The crossing of the two edges' Gauss arcs, if they cross at this orientation.
    #[inline]
    fn crossing(&self, edge_a: u32, edge_b: u32) -> Option<Crossing> {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let n = [self.b.planes[rod_b.faces[0] as usize].0, self.b.planes[rod_b.faces[1] as usize].0];
        let turned = self.r * rod_a.dir_turned;
        let p = [n[0].dot(turned), n[1].dot(turned)];
        let arc = |f: u32| -(self.r * self.a.normals_turned[f as usize]);
        let arc_a = [arc(rod_a.faces[0]), arc(rod_a.faces[1])];
        let q = [arc_a[0].dot(rod_b.dir), arc_a[1].dot(rod_b.dir)];
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
        if let Some(straight) = true_normal(n, self.r * rod_a.dir) {
            normal = straight;
            steady = p[0].abs().min(p[1].abs()).min(q[0].abs()).min(q[1].abs());
        }
        let a_at_b1 = usize::from(q[1] > 0.0);
        let b_at_a1 = usize::from(p[1] < 0.0);
        Some(Crossing { normal: normal.normalize(), arc_a, a_at_b1, b_at_a1, dir_a: turned, steady })
    }

    #[inline]
    fn edge_edge(&self, edge_a: u32, edge_b: u32, c: &Crossing, best: &mut Best, planes: &mut u32) -> Sides {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let n = c.normal;
        // x = b + beta u_B - R (a + alpha u_A) + f n
        let w = self.x + self.r * rod_a.origin - rod_b.origin;
        let distance = n.dot(w);
        let (e, under) = (-distance, (-distance).max(0.0));
        let along_b = n.cross(c.dir_a);
        let width_b = along_b.dot(rod_b.dir);
        let (along_b, width_b) = if width_b < 0.0 { (-along_b, -width_b) } else { (along_b, width_b) };
        let at_b = along_b.dot(w);
        let beyond_b = [-at_b, at_b - rod_b.length * width_b];
        let along_a = n.cross(rod_b.dir);
        let width_a = -along_a.dot(c.dir_a);
        let (along_a, width_a) = if width_a < 0.0 { (-along_a, -width_a) } else { (along_a, width_a) };
        let at_a = along_a.dot(w);
        let beyond_a = [-at_a, at_a - rod_a.length * width_a];
        // The ends of the arcs that the sides stand for.
        let ends_b = [c.arc_a[1 - c.a_at_b1], c.arc_a[c.a_at_b1]];
        let end_face =
            |end: usize| self.b.planes[rod_b.faces[if end == 1 { c.b_at_a1 } else { 1 - c.b_at_a1 }] as usize].0;
        let cosines_b = [n.dot(ends_b[0]), n.dot(ends_b[1])];
        let cosines_a = [n.dot(end_face(0)), n.dot(end_face(1))];
        // When A turns by an angle, the normal turns by at most `normal_turn` times that, a side by that and once more.
        let sine = width_b.max(width_a);
        let normal_turn = 1.4 / sine;
        let lever = self.a.radius + (1.0 + normal_turn) * (rod_a.length + rod_b.length + distance.abs());
        // The worst of all sides: the one nearest to x, the sharpest angle to a neighbour.
        let outermost = beyond_a[0].max(beyond_a[1]).max(beyond_b[0]).max(beyond_b[1]);
        let least = cosines_a[0].min(cosines_a[1]).min(cosines_b[0]).min(cosines_b[1]);
        let tan_half = ((1.0 - least) / (1.0 + least)).max(0.0).sqrt();
        let mut room = (0.8 * (-outermost - under * tan_half) / (1.0 + tan_half)).min(0.25 * sine * lever);
        let turn = (1.0 + normal_turn) * room / lever;
        if may_win(outermost + room, under + room, least - turn, 0.0) {
            room = 0.0;
        }
        for end in 0..2 {
            let (s, cosine) = (beyond_b[end], cosines_b[end]);
            if may_win(s, under, cosine, self.eps) {
                *planes += 1;
                let (next, m) = self.across_at_b(edge_a, edge_b, end, c);
                best.offer(s, e, n, m, self.eps, next);
            }
            let (s, cosine) = (beyond_a[end], cosines_a[end]);
            if may_win(s, under, cosine, self.eps) {
                *planes += 1;
                let (next, m) = self.across_at_a(edge_a, edge_b, end, c);
                best.offer(s, e, n, m, self.eps, next);
            }
        }
        Sides { distance, inside: -outermost, room, lever, normal_turn }
    }

    /// Across the side of a type-C C-face at an end of B's edge: along A's arc, in the cell of that vertex of B.
    fn across_at_b(&self, edge_a: u32, edge_b: u32, end: usize, c: &Crossing) -> (BasicContact, DVec3) {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let i = if end == 1 { c.a_at_b1 } else { 1 - c.a_at_b1 };
        let (vertex, target) = (rod_b.vertices[end], c.arc_a[i]);
        match first_crossing(self.b.spokes(vertex), -c.normal, -target, edge_b) {
            None => (type_a(rod_a.faces[i], vertex), target),
            Some((e, t)) => (type_c(edge_a, e), (c.normal + (target - c.normal) * t).normalize()),
        }
    }

    /// Across the side at an end of A's edge: along B's arc, in the cell of that vertex of A.
    fn across_at_a(&self, edge_a: u32, edge_b: u32, end: usize, c: &Crossing) -> (BasicContact, DVec3) {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let i = if end == 1 { c.b_at_a1 } else { 1 - c.b_at_a1 };
        let (vertex, face) = (rod_a.vertices[end], rod_b.faces[i]);
        let target = self.b.planes[face as usize].0;
        match first_crossing(self.a.spokes(vertex), self.rt * c.normal, self.rt * target, edge_a) {
            None => (type_b(vertex, face), target),
            Some((e, t)) => (type_c(e, edge_b), (c.normal + (target - c.normal) * t).normalize()),
        }
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
                        found(self.across_at_b(e.0, g.0, end, &c).0);
                        found(self.across_at_a(e.0, g.0, end, &c).0);
                    }
                }
            }
        }
    }

    /// The plane of a node that is known to be applicable; none where edges are too nearly parallel to be sure.
    #[inline]
    pub(crate) fn steady_plane(a: &Body, b: &Body, at: &At, node: BasicContact) -> Option<CFace> {
        let (x, r) = (at.pose.translation, &at.r);
        let (normal_w, distance) = match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let (n, d) = b.planes[face_b.index()];
                (n, n.dot(x + *r * a.points[vertex_a.index()]) - d)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let (n, d) = a.planes[face_a.index()];
                (-(*r * n), n.dot(r.transpose() * (b.points[vertex_b.index()] - x)) - d)
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                let (rod_a, rod_b) = (&a.rods[edge_a.index()], &b.rods[edge_b.index()]);
                let n = [b.planes[rod_b.faces[0] as usize].0, b.planes[rod_b.faces[1] as usize].0];
                let n = true_normal(n, *r * rod_a.dir)?.normalize();
                (n, n.dot(x + *r * rod_a.origin - rod_b.origin))
            }
        };
        Some(CFace { contact: node, normal_w, distance })
    }

    /// The plane of an applicable node.
    pub(crate) fn plane(&self, node: BasicContact) -> CFace {
        let (normal_w, distance) = match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let (n, d) = self.b.planes[face_b.index()];
                (n, n.dot(self.x + self.r * self.a.points[vertex_a.index()]) - d)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let (n, d) = self.a.planes[face_a.index()];
                (-(self.r * n), n.dot(self.rt * (self.b.points[vertex_b.index()] - self.x)) - d)
            }
            BasicContact::TypeC { edge_a, edge_b } => match self.crossing(edge_a.0, edge_b.0) {
                Some(c) => {
                    let w = self.x + self.r * self.a.rods[edge_a.index()].origin - self.b.rods[edge_b.index()].origin;
                    (c.normal, c.normal.dot(w))
                }
                None => (DVec3::Z, f64::NEG_INFINITY),
            },
        };
        CFace { contact: node, normal_w, distance }
    }

    /// A node next to the unit direction `m` (axes of W), where vertices `va` and `vb` support the two bodies, with
    /// no smaller signed distance than `m` has: out of the overlaid cell along the gradient, then along its border.
    pub(crate) fn node_from_direction(&self, m: DVec3, va: u32, vb: u32) -> BasicContact {
        let w = self.x + self.r * self.a.points[va as usize] - self.b.points[vb as usize];
        let mut d = w - m * m.dot(w);
        if !(d.length_squared() > 1e-24 * w.length_squared()) {
            d = m.any_orthonormal_vector();
        }
        let exit_b = self.exit(self.b.spokes(vb), -m, -d);
        let exit_a = self.exit(self.a.spokes(va), self.rt * m, self.rt * d);
        if exit_b.1 <= exit_a.1 {
            if exit_b.0 == NO_EDGE {
                return type_b(va, self.b.face_of_vertex[vb as usize]);
            }
            let n = (m + d * exit_b.1).normalize();
            let faces = self.b.rods[exit_b.0 as usize].faces;
            // Along B's arc, uphill.
            let ends = faces.map(|f| self.b.planes[f as usize].0);
            let up = usize::from((ends[1] - ends[0]).dot(w - n * n.dot(w)) > 0.0);
            match first_crossing(self.a.spokes(va), self.rt * n, self.rt * ends[up], NO_EDGE) {
                None => type_b(va, faces[up]),
                Some((e, _)) => type_c(e, exit_b.0),
            }
        } else {
            let n = (m + d * exit_a.1).normalize();
            let faces = self.a.rods[exit_a.0 as usize].faces;
            let ends = faces.map(|f| -(self.r * self.a.normals_turned[f as usize]));
            let up = usize::from((ends[1] - ends[0]).dot(w - n * n.dot(w)) > 0.0);
            match first_crossing(self.b.spokes(vb), -n, -ends[up], NO_EDGE) {
                None => type_a(faces[up], vb),
                Some((e, _)) => type_c(exit_a.0, e),
            }
        }
    }

    /// Where a ray from `m` along `d` leaves a vertex' cell: the edge and the parameter.
    fn exit(&self, spokes: &[Spoke], m: DVec3, d: DVec3) -> (u32, f64) {
        let mut out = (NO_EDGE, f64::INFINITY);
        for s in spokes {
            let slope = d.dot(s.to);
            if slope < 0.0 {
                let t = m.dot(s.to).max(0.0) / -slope;
                if t < out.1 {
                    out = (s.edge, t);
                }
            }
        }
        out
    }
}

/// A multiple of the normal of the plane along the edge between B's faces with normals `n` and A's edge along `u`; none
/// if the edges are nearly parallel or A's does not pass between the faces.
#[inline]
fn true_normal(n: [DVec3; 2], u: DVec3) -> Option<DVec3> {
    let p = [n[0].dot(u), n[1].dot(u)];
    (p[0] * p[1] < 0.0 && (p[0] - p[1]).abs() > 1e-9).then(|| n[0] * p[1].abs() + n[1] * p[0].abs())
}

/// Whether a neighbour between here and the end of the arc (cosine of the angle to it) could be better.
#[inline]
fn may_win(s: f64, under: f64, cosine: f64, eps: f64) -> bool {
    s > eps || (under > 0.0 && under * under * (1.0 - cosine) >= (s - eps) * (s - eps) * (1.0 + cosine))
}

impl Best {
    /// Takes the neighbour with normal `m` across a side if it is better than this plane and than what was offered.
    #[inline]
    fn offer(&mut self, s: f64, e: f64, n: DVec3, m: DVec3, eps: f64, node: BasicContact) {
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
