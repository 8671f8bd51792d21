//! A pair that is calm: however A moves within some way of a pose, Near stays Near as long as it is applicable, and its depth the least.
//!
//! Each test is one of those that a step makes (`stay`, `certificate`), passed by as much as its numbers can change: no point of A moves
//! by more than the way, no direction turns by more than the way over A's radius. Whether Near is applicable may have to be told at each
//! pose: where parts are nearly aligned, as they are in a hand, that hangs on angles too small to leave room.

use crate::body::TIE_BREAK;
use crate::certificate::Certificate;
use crate::crossing::{normal_between, true_normal};
use crate::fold::Fold;
use crate::parallelogram::Parallelogram;
use crate::placed::Placed;
use crate::{BasicContact, Body, CFace};
use spatial::DVec3;

/// Edges that cross at a sine not larger than this number of turns are never calm.
const STEEP: f64 = 4.0;

/// By how much what is known of a pair may change.
#[derive(Clone, Copy)]
pub(crate) struct Unrest {
    /// Metres.
    pub way: f64,
    /// Of Near's normal, radians.
    pub normal: f64,
}

/// Near, where no neighbour comes to be nearer.
struct Stays {
    near: CFace,
    /// How far x's projection stays inside of the C-face's sides, metres.
    inside: f64,
    unrest: Unrest,
    /// Of two edges the sine of the angle between them; the sides of a face do not turn.
    sine: Option<f64>,
}

impl Placed<'_> {
    /// Near's plane as a step gives it that finds Near to stay; none if Near may not be applicable, which is not asked if that is known.
    #[inline]
    pub(crate) fn plane_if_applicable(&self, node: BasicContact, is_known: bool) -> Option<CFace> {
        let (normal_w, distance) = match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let up = || self.turn_to_a(self.b.normals_turned[face_b.index()]);
                if !(is_known || is_lowest(self.a, vertex_a.0, up(), 0.0)) {
                    return None;
                }
                let (n, d) = self.b.planes[face_b.index()];
                (n, n.dot(self.point_in_w(self.a.points[vertex_a.index()])) - d)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let up = || self.turn_to_w(self.a.normals_turned[face_a.index()]);
                if !(is_known || is_lowest(self.b, vertex_b.0, up(), 0.0)) {
                    return None;
                }
                let (n, d) = self.a.planes[face_a.index()];
                (-self.turn_to_w(n), n.dot(self.point_in_a(self.b.points[vertex_b.index()])) - d)
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                let (rod_a, rod_b) = (&self.a.rods[edge_a.index()], &self.b.rods[edge_b.index()]);
                let u = self.turn_to_w(rod_a.dir);
                let normals_b = rod_b.faces.map(|f| self.b.planes[f as usize].0);
                let p = normals_b.map(|n| n.dot(u));
                let n = normal_between(normals_b, p)?;
                if !(is_known || self.surely_cross(edge_a.0, edge_b.0, p, n)) {
                    return None;
                }
                let n = n.normalize();
                (n, n.dot(self.between_edges(edge_a.0, edge_b.0)))
            }
        };
        Some(CFace { contact: node, normal_w, distance })
    }

    /// Whether a node that is applicable stays so while A turns by no more than the way over A's radius.
    pub(crate) fn stays_applicable(&self, node: BasicContact, way: f64) -> bool {
        let turn = way / self.a.radius + 10.0 * TIE_BREAK;
        match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                is_lowest(self.a, vertex_a.0, self.turn_to_a(self.b.normals_turned[face_b.index()]), turn)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                is_lowest(self.b, vertex_b.0, self.turn_to_w(self.a.normals_turned[face_a.index()]), turn)
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                self.crossing(edge_a.0, edge_b.0).is_some_and(|crossing| crossing.steady > turn)
            }
        }
    }

    /// Whether the pair is calm within a way, metres: see above.
    pub(crate) fn is_calm(&self, node: BasicContact, certificate: &Certificate, way: f64) -> bool {
        self.stays(node, way).is_some_and(|Stays { near, inside, unrest, sine }| {
            let folded = || self.folded_disc_within(&near, unrest, way / self.a.radius, sine);
            near.distance > unrest.way
                || certificate.proves_within(self, &near, inside, unrest)
                || certificate.proves_within(self, &near, folded(), unrest)
        })
    }

    /// Near, if no neighbour comes to be nearer within the way, metres.
    fn stays(&self, node: BasicContact, way: f64) -> Option<Stays> {
        let turn = way / self.a.radius;
        match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let p = self.point_in_w(self.a.points[vertex_a.index()]);
                self.stays_over_face::<false>(vertex_a.0, face_b.0, p, (way, turn)).map(|(distance, inside)| {
                    let near = CFace { contact: node, normal_w: self.b.planes[face_b.index()].0, distance };
                    Stays { near, inside, unrest: Unrest { way, normal: 0.0 }, sine: None }
                })
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let q = self.point_in_a(self.b.points[vertex_b.index()]);
                // As A sees it, a point of B moves the more the farther off it is.
                let way = way * (((q - self.a.center).length() / self.a.radius).max(1.0) + 0.1);
                self.stays_over_face::<true>(vertex_b.0, face_a.0, q, (way, turn)).map(|(distance, inside)| {
                    let normal_w = -self.turn_to_w(self.a.planes[face_a.index()].0);
                    let near = CFace { contact: node, normal_w, distance };
                    Stays { near, inside, unrest: Unrest { way, normal: turn }, sine: None }
                })
            }
            BasicContact::TypeC { edge_a, edge_b } => self.stay_crossed(edge_a.0, edge_b.0, way, turn),
        }
    }

    /// What the folded disc about the SCP counts for at least while the pair changes by no more than `unrest` and A turns by no more than
    /// `turn`, metres; `sine` is that of Near's edges.
    ///
    /// The disc's half across the side lies in the C-face that is there now. While A moves that may cease to be one, but it is spanned
    /// by points of the C-obstacle, and goes on to be in it: so its half counts as long as `x` is no deeper under Near than under its
    /// plane, which is told by the angle of the fold. Of a vertex and a face it is rigid. Of two edges the angle between them changes by
    /// no more than the turn.
    fn folded_disc_within(&self, near: &CFace, unrest: Unrest, turn: f64, sine: Option<f64>) -> f64 {
        let Some(Fold { s, at_home, across, at_away }) = self.fold(near) else { return 0.0 };
        let (m, away) = match across {
            BasicContact::TypeB { face_b, .. } => (self.b.planes[face_b.index()].0, (0.0, 1.0)),
            BasicContact::TypeA { face_a, .. } => (-self.turn_to_w(self.a.planes[face_a.index()].0), (turn, 1.0)),
            BasicContact::TypeC { edge_a, edge_b } => {
                let (rod_a, rod_b) = (&self.a.rods[edge_a.index()], &self.b.rods[edge_b.index()]);
                let u = self.turn_to_w(rod_a.dir);
                let Some(m) = true_normal(rod_b.faces.map(|f| self.b.planes[f as usize].0), u) else { return 0.0 };
                let sine = u.cross(rod_b.dir).length();
                if !(sine > STEEP * turn) {
                    return 0.0;
                }
                (m.normalize(), (turn / (0.75 * sine), 1.0 - turn / sine))
            }
        };
        let (e, n) = ((-near.distance).max(0.0) + unrest.way, near.normal_w);
        let more = 0.55 * (unrest.normal + away.0);
        let tan_half = ((m - n).length_squared() / (m + n).length_squared().max(1e-300)).sqrt();
        let moves = |beyond: f64| {
            unrest.way + sine.map_or(0.0, |sine| (beyond.abs() / sine + near.distance.abs()) * (turn + unrest.normal))
        };
        let [least, most] = [s - moves(s), s + moves(s)];
        if !(tan_half * more < 0.5 && least > e * (tan_half + more) / (1.0 - tan_half * more)) {
            return 0.0;
        }
        // Where the side is nearest to the SCP is a place on an edge, and moves along it as the SCP does, seen from either body.
        let way = unrest.way * (1.1 + (s + e) / self.a.radius);
        (at_home - moves(at_home) - most).min((at_away - way) * away.1) - most
    }

    /// The plane of two edges, how far x's projection stays inside of the C-face's sides, metres, and by how much the plane may change;
    /// none if a neighbour could come to be nearer.
    fn stay_crossed(&self, edge_a: u32, edge_b: u32, way: f64, turn: f64) -> Option<Stays> {
        let (rod_a, rod_b) = (&self.a.rods[edge_a as usize], &self.b.rods[edge_b as usize]);
        let u = self.turn_to_w(rod_a.dir);
        let normals_b = rod_b.faces.map(|f| self.b.planes[f as usize].0);
        let p = normals_b.map(|n| n.dot(u));
        let n = normal_between(normals_b, p)?;
        let ends_a = rod_a.faces.map(|f| -self.turn_to_w(self.a.planes[f as usize].0));
        let n = n.normalize();
        let w = self.between_edges(edge_a, edge_b);
        let face = Parallelogram::new(n, w, (u, rod_a.length), (rod_b.dir, rod_b.length));
        if !(face.sine > STEEP * turn) {
            return None;
        }
        // The angle between the edges stays at least three quarters of what it is.
        let normal = turn / (0.75 * face.sine);
        let distance = n.dot(w);
        let under = (-distance).max(0.0) + way;
        // Half of what the angle between Near's normal and an arc's end may gain.
        let more = 0.55 * (turn + normal);
        let mut outermost = f64::NEG_INFINITY;
        let mut stays = |beyond: f64, m: DVec3| {
            // A side moves by no more than the way, where the edges cross, and turns about there.
            let s = beyond + way + (beyond.abs() / face.sine + distance.abs()) * (turn + normal);
            outermost = outermost.max(s);
            let tan_half = ((m - n).length_squared() / (m + n).length_squared().max(1e-300)).sqrt();
            tan_half * more < 0.5 && s + under * (tan_half + more) / (1.0 - tan_half * more) < 0.0
        };
        let all = (0..2).all(|end| {
            stays(face.beyond_b[end], ends_a[self.arc_at_b(edge_a, edge_b, end)])
                && stays(face.beyond_a[end], normals_b[self.arc_at_a(edge_a, edge_b, end)])
        });
        let contact = crate::c_face::type_c(edge_a, edge_b);
        let near = CFace { contact, normal_w: n, distance };
        all.then_some(Stays { near, inside: -outermost, unrest: Unrest { way, normal }, sine: Some(face.sine) })
    }

    /// Distance of `p` (the face's frame), a vertex of the other body, to a face's plane, and how far its projection stays inside of the
    /// face while it moves by no more than `way`, metres, and A turns by no more than `turn`; none if the plane across one of its sides
    /// could come to be nearer.
    fn stays_over_face<const OF_A: bool>(
        &self,
        vertex: u32,
        face: u32,
        p: DVec3,
        (way, turn): (f64, f64),
    ) -> Option<(f64, f64)> {
        let (body, other) = if OF_A { (self.a, self.b) } else { (self.b, self.a) };
        let (n, d) = body.planes[face as usize];
        let distance = n.dot(p) - d;
        let under = (-distance).max(0.0) + way;
        let mut outermost = f64::NEG_INFINITY;
        for side in body.sides(face) {
            let s = side.out.dot(p) - side.offset + way;
            outermost = outermost.max(s);
            if s + under * side.tan_half >= 0.0 {
                // Not as far as the next face: the other body's edges come first.
                let [from, to] = [face, side.face].map(|f| body.normals_turned[f as usize]);
                let [m0, m1] = [from, to].map(|m| if OF_A { self.turn_to_w(m) } else { self.turn_to_a(m) });
                let t = farthest_crossing(other, vertex, [m0, m1], turn);
                let m = from + (to - from) * t;
                let tan_half =
                    ((m - from * m.length()).length_squared() / (m + from * m.length()).length_squared()).sqrt();
                if !(s + under * tan_half < 0.0) {
                    return None;
                }
            }
        }
        Some((distance, -outermost))
    }
}

/// Whether all edges at the vertex rise along `up` by more than this sine, and the vertex is the body's lowest.
#[inline]
fn is_lowest(body: &Body, vertex: u32, up: DVec3, least: f64) -> bool {
    body.spokes(vertex).iter().all(|s| up.dot(s.to) > least)
}

/// How far along the arc from `m0` to `m1` the first spoke may come to be crossed, if they turn by no more than `turn`: see
/// [`crate::crossing::first_crossing`].
fn farthest_crossing(body: &Body, vertex: u32, [m0, m1]: [DVec3; 2], turn: f64) -> f64 {
    let mut first = 1.0_f64;
    for s in body.spokes(vertex) {
        let (g0, g1) = (m0.dot(s.to).max(0.0) + turn, m1.dot(s.to) + turn);
        if g1 < 0.0 {
            first = first.min(g0 / (g0 - g1));
        }
    }
    first
}

#[cfg(test)]
mod tests;
