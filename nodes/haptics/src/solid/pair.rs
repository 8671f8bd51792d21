//! A part and a piece where they are: which of their contact planes may be felt, and which lie nearest.

use crate::solid::features::{edges_of_a, edges_of_b, vertices_of_a, vertices_of_b};
use crate::solid::{Cover, Placed, Sensed, Solids};
use cspace::{
    BasicContact, CFace, Edge, EdgeId, FaceId, Plane, Polyhedron, contact_point_turned, is_applicable_turned,
};
use spatial::DVec3;
use std::slice;

/// Cosine between normals from which on two C-faces of a pair count as one.
pub(crate) const SAME: f64 = 0.999;
/// Normals with a larger cosine still count as one when they have turned by [`TURN`], radians.
const NEARLY_SAME: f64 = 0.9995;
pub(crate) const TURN: f64 = 0.01;
/// What the cosine between the normals of one face may lack of one.
const SAME_NORMAL: f64 = 1e-12;

/// Whether a face that other pieces cover in part is felt where they do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Covered {
    /// Not where both the contact and A's middle stand over covered parts.
    Unfelt,
    /// Anywhere: for a pair that nothing else frees. In an obtuse corner both may stand beyond the corner.
    Felt,
}

/// A convex part of A, where it is placed, and a convex piece of the obstacles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'a> {
    pub solids: &'a Solids,
    /// Indices in their assemblies.
    pub part: usize,
    pub piece: usize,
    pub a: &'a Polyhedron,
    pub b: &'a Polyhedron,
    pub placed: &'a Placed,
}

impl<'a> Pair<'a> {
    /// A part and a piece, A being where it is placed.
    pub fn new(solids: &'a Solids, part: u32, piece: u32, placed: &'a Placed) -> Self {
        let (part, piece) = (part as usize, piece as usize);
        Self { solids, part, piece, a: solids.part(part), b: solids.piece(piece), placed }
    }

    /// The pair that was sensed.
    pub fn of(solids: &'a Solids, sensed: &Sensed, placed: &'a Placed) -> Self {
        Self::new(solids, sensed.part, sensed.piece, placed)
    }

    /// Whether the contact is one of the uncut solids. Vertices and edges are judged where they are; a face that is
    /// covered in part is felt while A's contact or A's middle stands over the open part. (The contact alone does not
    /// decide: deep in a corner it lies inside the other wall, and still this wall must push.)
    fn is_felt_plane(&self, c: &CFace, covered: Covered) -> bool {
        let Self { solids: Solids { moving, fixed, .. }, part, piece, a, b, placed } = *self;
        let at = || contact_point_turned(c.contact, a, b, placed.x, &placed.r);
        let into_a = placed.r.transpose();
        let seen_from_a = |p: DVec3| into_a * (p - placed.x);
        match c.contact {
            BasicContact::TypeB { vertex_a, face_b } => {
                let face_felt = match fixed.cover(piece, face_b) {
                    Cover::Open => true,
                    Cover::Internal => false,
                    Cover::Partial if covered == Covered::Felt => true,
                    Cover::Partial => [at(), placed.point(a.center())]
                        .iter()
                        .any(|p| !fixed.is_covered(piece, face_b, nearest_in_face(b, face_b, *p))),
                };
                face_felt && (moving.is_alone(part) || moving.is_felt_at_vertex(part, vertex_a, -(into_a * c.normal_w)))
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let face_felt = match moving.cover(part, face_a) {
                    Cover::Open => true,
                    Cover::Internal => false,
                    Cover::Partial if covered == Covered::Felt => true,
                    Cover::Partial => [at(), b.center()]
                        .iter()
                        .any(|p| !moving.is_covered(part, face_a, nearest_in_face(a, face_a, seen_from_a(*p)))),
                };
                face_felt && (fixed.is_alone(piece) || fixed.is_felt_at_vertex(piece, vertex_b, c.normal_w))
            }
            BasicContact::TypeC { edge_b, .. } => {
                (fixed.is_alone(piece) || fixed.is_felt_on_edge(piece, edge_b, at, c.normal_w))
                    && (moving.is_alone(part) || {
                        let on_a = seen_from_a(at() + c.normal_w * c.distance);
                        moving.is_felt(part, on_a, -(into_a * c.normal_w))
                    })
            }
        }
    }

    /// Whether the plane of some face of either body, seam or not, has the other outside but for `slack` metres: proof that
    /// the pair is free.
    pub fn a_face_parts(&self, slack: f64) -> bool {
        let Self { a, b, placed, .. } = *self;
        let (center_a, center_b) = (placed.point(a.center()), placed.seen_from_a(b.center()));
        // A body lies between the ball it holds and the ball that holds it: that settles most planes.
        b.faces().any(|f| {
            let over = b.face_plane(f).signed_distance(center_a) + slack;
            over >= a.inner_radius() && (over >= a.size() || plane_of_face_b(a, b, placed, f).distance >= -slack)
        }) || a.faces().any(|f| {
            let over = a.face_plane(f).signed_distance(center_b) + slack;
            over >= b.inner_radius() && (over >= b.size() || plane_of_face_a(a, b, placed, f).distance >= -slack)
        })
    }

    /// Whether a plane across `normal_w` has the piece behind it and the part before it but for `slack` metres, which may be
    /// negative: proof that the pair is free.
    pub fn is_parted_along(&self, normal_w: DVec3, slack: f64) -> bool {
        let Self { a, b, placed, .. } = *self;
        let lowest = placed.point(a.vertex(a.support(-(placed.r.transpose() * normal_w))));
        normal_w.dot(lowest - b.vertex(b.support(normal_w))) >= -slack
    }

    /// Whether the pair's nearest plane is one of the uncut solids.
    pub fn is_felt(&self, near: &CFace, covered: Covered) -> bool {
        self.solids.is_seamless(self.part, self.piece) || self.is_felt_plane(near, covered)
    }

    /// Where `near` takes place and another C-face meets it there, within `tie` metres: the felt one, of a face at Near's features
    /// or beside its face, that leaves most of the motion free which Near forbids. The pair is free on the side of either.
    /// Also by how much less than `tie` lies the plane that comes nearest to it, metres, up to `room`: none ties within so small a motion.
    pub fn tied_plane(&self, near: &CFace, tie: f64, room: f64) -> (Option<CFace>, f64) {
        let mut best = None;
        let mut against = SAME;
        let mut nearest = -tie - room;
        self.offer_planes_beside(near, nearest, NEARLY_SAME, |face| {
            nearest = nearest.max(face.distance);
            let alike = face.normal_w.dot(near.normal_w);
            if face.distance >= -tie && alike < against && self.is_felt(&face, Covered::Unfelt) {
                against = alike;
                best = Some(face);
            }
        });
        (best, -tie - nearest)
    }

    /// Offers the planes of the faces at Near's features, or beside its face, that differ from Near's by a cosine of less than `alike`
    /// and whose signed distance is `least` (metres) or more.
    pub fn offer_planes_beside(&self, near: &CFace, least: f64, alike: f64, mut offer: impl FnMut(CFace)) {
        let Self { a, b, placed, .. } = *self;
        let (faces_a, vertex_a, faces_b, vertex_b): (&[FaceId], _, &[FaceId], _) = match near.contact {
            BasicContact::TypeA { face_a, vertex_b } => {
                (a.face_faces(face_a), a.face_vertices(face_a)[0], b.vertex_faces(vertex_b), vertex_b)
            }
            BasicContact::TypeB { vertex_a, face_b } => {
                (a.vertex_faces(vertex_a), vertex_a, b.face_faces(face_b), b.face_vertices(face_b)[0])
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                (&a.edge(edge_a).faces, a.edge(edge_a).vertices[0], &b.edge(edge_b).faces, b.edge(edge_b).vertices[0])
            }
        };
        // A body lies at least as far behind a plane as any of its vertices, and as the ball that it holds.
        let at_a = placed.point(a.vertex(vertex_a));
        for face_b in faces_b {
            let plane = b.face_plane(*face_b);
            if plane.signed_distance(at_a) >= least
                && plane.normal.dot(near.normal_w) < alike
                && plane.signed_distance(placed.point(a.center())) - a.inner_radius() >= least
                && !self.solids.is_internal_b(self.piece, *face_b)
            {
                let face = plane_of_face_b(a, b, placed, *face_b);
                if face.distance >= least {
                    offer(face);
                }
            }
        }
        let at_b = placed.seen_from_a(b.vertex(vertex_b));
        for face_a in faces_a {
            let plane = a.face_plane(*face_a);
            if plane.signed_distance(at_b) >= least
                && (placed.r * plane.normal).dot(near.normal_w) > -alike
                && plane.signed_distance(placed.seen_from_a(b.center())) - b.inner_radius() >= least
                && !self.solids.is_internal_a(self.part, *face_a)
            {
                let face = plane_of_face_a(a, b, placed, *face_a);
                if face.distance >= least {
                    offer(face);
                }
            }
        }
    }

    /// By how much the normal of a contact turns at most for each radian that the part turns.
    pub fn leverage(&self, contact: BasicContact) -> f64 {
        match contact {
            BasicContact::TypeC { edge_a, edge_b } => {
                let along_a = self.placed.r * self.a.edge_direction(edge_a);
                1.0 / along_a.cross(self.b.edge_direction(edge_b)).length()
            }
            _ => 1.0,
        }
    }

    /// The plane of a contact if it can take place at this orientation.
    pub fn applicable_plane(&self, contact: BasicContact) -> Option<CFace> {
        let Self { a, b, placed, .. } = *self;
        is_applicable_turned(contact, a, b, &placed.r).then(|| CFace::at_turned(contact, a, b, placed.x, &placed.r))
    }

    /// Where `near` is not felt: the felt C-face with the largest signed distance among the face contacts and, around the
    /// best of them and around `near`, the edge contacts. None if nothing is felt. `hint` is the pair's last answer: what
    /// cannot better it is not looked at.
    pub fn felt_plane(&self, near: &CFace, covered: Covered, hint: &mut Option<BasicContact>) -> Option<CFace> {
        let last = hint.and_then(|c| self.applicable_plane(c)).filter(|c| self.is_felt_plane(c, covered));
        let best = self.felt_from(near, covered, last);
        *hint = best.map(|c| c.contact);
        best
    }

    /// The felt contact of a face with the largest signed distance, if that exceeds `known`, metres.
    fn felt_face(&self, near: &CFace, covered: Covered, known: f64) -> Option<CFace> {
        let mut best = None;
        self.each_face(near, known, |face, known| {
            if face.distance > known && self.is_felt_plane(&face, covered) {
                best = Some(face);
                return face.distance;
            }
            known
        });
        best
    }

    /// How far the signed distance of `plane` exceeds those of all other faces that are felt where they are open, up to `most`, metres.
    pub fn lead_over_faces(&self, near: &CFace, plane: &CFace, most: f64) -> f64 {
        let mut rival = plane.distance - most;
        self.each_face(near, rival, |face, known| {
            if face.distance > known
                && face.normal_w.dot(plane.normal_w) < 1.0 - SAME_NORMAL
                && self.is_felt_plane(&face, Covered::Felt)
            {
                rival = face.distance;
            }
            rival
        });
        plane.distance - rival
    }

    /// Gives `each` the contacts of the faces whose signed distances may exceed what is known, metres: at first `known`, then
    /// what it answers.
    fn each_face(&self, near: &CFace, mut known: f64, mut each: impl FnMut(CFace, f64) -> f64) {
        let Self { a, b, placed, .. } = *self;
        let (center_a, center_b) = (placed.point(a.center()), placed.seen_from_a(b.center()));
        // A body lies at least as far behind a plane as the ball that it holds, and as any vertex: those at Near tell most.
        let (ball_a, ball_b) = (a.inner_radius(), b.inner_radius());
        let [i, j, k] = vertices_of_a(a, &near.contact);
        let at_a = [placed.point(a.vertex(i)), placed.point(a.vertex(j)), placed.point(a.vertex(k))];
        let [i, j, k] = vertices_of_b(b, &near.contact);
        let at_b = [placed.seen_from_a(b.vertex(i)), placed.seen_from_a(b.vertex(j)), placed.seen_from_a(b.vertex(k))];
        let is_beyond = |plane: &Plane, center: DVec3, ball: f64, at: &[DVec3; 3], known: f64| {
            plane.signed_distance(center) - ball > known && at.iter().all(|p| plane.signed_distance(*p) > known)
        };
        for face_b in b.faces().filter(|f| !self.solids.is_internal_b(self.piece, *f)) {
            if is_beyond(&b.face_plane(face_b), center_a, ball_a, &at_a, known) {
                known = each(plane_of_face_b(a, b, placed, face_b), known);
            }
        }
        for face_a in a.faces().filter(|f| !self.solids.is_internal_a(self.part, *f)) {
            if is_beyond(&a.face_plane(face_a), center_b, ball_b, &at_b, known) {
                known = each(plane_of_face_a(a, b, placed, face_a), known);
            }
        }
    }

    /// See [`Pair::felt_plane`]; `best` is known already.
    fn felt_from(&self, near: &CFace, covered: Covered, mut best: Option<CFace>) -> Option<CFace> {
        // No plane is nearer than Near's: a tie cannot be bettered.
        let tie = near.distance - 1e-12;
        if best.is_some_and(|f| f.distance >= tie) {
            return best;
        }
        let Self { a, b, placed, .. } = *self;
        best = self.felt_face(near, covered, best.map_or(f64::NEG_INFINITY, |f| f.distance)).or(best);
        if best.is_some_and(|f| f.distance >= tie) {
            return best;
        }
        let (live_a, live_b) = (self.solids.moving.live_edges(self.part), self.solids.fixed.live_edges(self.piece));
        // Edge contacts: walk from the best face contact, and from Near's own features, over adjacent edges.
        for start in [best.map(|f| f.contact), Some(near.contact)].into_iter().flatten() {
            let mut at = start;
            for _ in 0..4 {
                let from = best;
                // Beside two edges lie one of them and a neighbour of the other, too.
                let (own_a, own_b) = match &at {
                    BasicContact::TypeC { edge_a, edge_b } => (slice::from_ref(edge_a), slice::from_ref(edge_b)),
                    _ => (&[][..], &[][..]),
                };
                let edges_a = own_a.iter().chain(edges_of_a(a, &at));
                for edge_a in edges_a.filter(|e| live_a[e.index()]) {
                    let along_a = placed.r * a.edge_direction(*edge_a);
                    let on_a = || placed.point(a.vertex(a.edge(*edge_a).vertices[0]));
                    let edges_b = own_b.iter().chain(edges_of_b(b, &at));
                    for edge_b in edges_b.filter(|e| live_b[e.index()]) {
                        if best.is_some_and(|o| !may_better(along_a, &on_a, b, *edge_b, o.distance)) {
                            continue;
                        }
                        let c = BasicContact::TypeC { edge_a: *edge_a, edge_b: *edge_b };
                        let face = CFace::at_turned(c, a, b, placed.x, &placed.r);
                        if best.is_none_or(|o| face.distance > o.distance)
                            && is_applicable_turned(c, a, b, &placed.r)
                            && self.is_felt_plane(&face, covered)
                        {
                            best = Some(face);
                        }
                    }
                }
                match best {
                    Some(face) if best != from => at = face.contact,
                    _ => break,
                }
            }
        }
        best
    }
}

/// Whether the plane of two edges can take place, as far as B's edge tells, with a signed distance larger than `known`,
/// metres, as far as the squares of both tell, which need no root.
#[inline]
fn may_better(along_a: DVec3, on_a: &impl Fn() -> DVec3, b: &Polyhedron, edge_b: EdgeId, known: f64) -> bool {
    let Edge { vertices: [at_b, _], faces: [f, g] } = b.edge(edge_b);
    let (n, m) = (b.face_plane(f).normal, b.face_plane(g).normal);
    let (p, q) = (n.dot(along_a), m.dot(along_a));
    if !(p * q < 0.0) {
        return false;
    }
    // Along the edge's arc on the Gauss sphere, where it crosses the circle of A's edge.
    let outward = n * q.abs() + m * p.abs();
    let over = outward.dot(on_a() - b.vertex(at_b));
    over * over.abs() > known * known.abs() * outward.length_squared()
}

/// The plane of a face of A against the vertex of B that it meets first: type A.
fn plane_of_face_a(a: &Polyhedron, b: &Polyhedron, placed: &Placed, face_a: FaceId) -> CFace {
    let plane = a.face_plane(face_a);
    let normal_w = -(placed.r * plane.normal);
    let vertex_b = b.support(normal_w);
    let distance = normal_w.dot(placed.x - b.vertex(vertex_b)) - plane.distance;
    CFace { contact: BasicContact::TypeA { face_a, vertex_b }, normal_w, distance }
}

/// The plane of a face of B against the vertex of A that it meets first: type B.
fn plane_of_face_b(a: &Polyhedron, b: &Polyhedron, placed: &Placed, face_b: FaceId) -> CFace {
    let plane = b.face_plane(face_b);
    let vertex_a = a.support(-(placed.r.transpose() * plane.normal));
    let distance = plane.signed_distance(placed.point(a.vertex(vertex_a)));
    CFace { contact: BasicContact::TypeB { vertex_a, face_b }, normal_w: plane.normal, distance }
}

/// The foot of `p` on the face's plane, drawn into the face side by side: near its nearest point, and inside.
pub(crate) fn nearest_in_face(body: &Polyhedron, face: FaceId, p: DVec3) -> DVec3 {
    let plane = body.face_plane(face);
    let foot = p - plane.normal * plane.signed_distance(p);
    if body.face_sides(face).iter().all(|side| side.signed_distance(foot) <= 0.0) {
        return foot;
    }
    let ring = body.face_vertices(face);
    let middle = ring.iter().map(|v| body.vertex(*v)).sum::<DVec3>() / ring.len() as f64;
    // Towards the middle, as far as the side asks that cuts most.
    let mut share = 1.0_f64;
    for side in body.face_sides(face) {
        let (out, inside) = (side.signed_distance(foot), -side.signed_distance(middle));
        if out > 0.0 {
            share = share.min(inside / (inside + out));
        }
    }
    middle + (foot - middle) * share
}
