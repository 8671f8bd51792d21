//! The contact region of a pair: the two faces in contact, clipped against each other, as basic contacts.

use crate::face_pair::{Corner, FacePair, PARALLEL_EDGES};
use crate::facing::facing_point;
use crate::pair::Pair;
use crate::seams::Cover;
use crate::sense::Sensed;
use crate::span::{Cut, Span};
use cspace::{BasicContact, CFace, FaceId, Polyhedron, World};
use spatial::DVec3;

/// A basic contact of the region: one of the paper's K contacts when it takes place, a potential one when it has a gap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionPoint {
    pub contact: BasicContact,
    /// App_k, metres, W: on the surface of B.
    pub point_w: DVec3,
    /// Unit, axes of W, from B to A.
    pub normal_w: DVec3,
    /// Signed distance of A to B at this contact, metres, `< 0` is penetration: along the normal, or along Near's: see [`Scope`].
    pub gap: f64,
}

impl RegionPoint {
    /// The contact of a plane itself, at `point_w` on B.
    pub fn of(plane: &CFace, point_w: DVec3) -> Self {
        Self { contact: plane.contact, point_w, normal_w: plane.normal_w, gap: plane.distance }
    }

    /// A crossing of edges (unit directions, axes of W) whose place on A has moved by `motion`: the place slides along B's edge,
    /// the normal stays across both. One that has the face's normal keeps it.
    pub fn follow_crossing(&mut self, along_a: DVec3, along_b: DVec3, motion: DVec3) {
        let n = along_a.cross(along_b);
        let length = n.length();
        let lean = n.dot(self.normal_w);
        if length <= PARALLEL_EDGES || lean.abs() < 0.9999 * length {
            return;
        }
        self.point_w += along_b * (motion.cross(along_a).dot(n) / -(length * length));
        self.normal_w = n * (lean.signum() / length);
    }
}

/// Which contacts of a region are wanted, and seen in which direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scope {
    /// Contacts with a gap of up to this, metres: along their own normals, or along Near's if seen along it.
    pub reach: f64,
    /// Near's own contact, at its exact place.
    pub near_felt: bool,
    /// Not only of the two most nearly parallel faces, but of all at Near's features that lean less than 60 degrees.
    pub wide: bool,
    /// The faces are laid on each other along Near's normal, in which the crossing of Near's edges is exact; else along the
    /// normal of B's face, in which A's vertices touch it.
    pub along_near: bool,
}

/// Scratch for clipping; grows at construction only.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clipper {
    /// The vertices of A's face, W, and the first again.
    ring: Vec<DVec3>,
    /// Which sides of B's face have something of A's face beyond them.
    cuts: Vec<bool>,
    /// Of each edge of A's face, which leaves the vertex of the same index.
    spans: Vec<Span>,
    pairs: Vec<(FaceId, FaceId)>,
}

/// Contacts closer together than this part of the size are one.
const SAME_POINT: f64 = 1e-8;
/// Normals that differ by less, radians, bound one motion.
const ONE_DIRECTION: f64 = 1e-4;
/// Most pairs of faces clipped for one contact, and the cosine up to which they count as facing each other.
const MAX_PAIRS: usize = 8;
const FACING: f64 = -0.5;

impl Clipper {
    /// Room for the largest faces of the world.
    pub fn for_world(world: &World) -> Self {
        let most = |p: &Polyhedron| p.faces().map(|f| p.face_vertices(f).len()).max().unwrap_or(0);
        let room = world.moving.iter().map(|p| most(p)).max().unwrap_or(0);
        let sides = world.fixed.iter().map(|p| most(&p.polyhedron)).max().unwrap_or(0);
        Self {
            ring: Vec::with_capacity(room + 1),
            cuts: Vec::with_capacity(sides),
            spans: Vec::with_capacity(room),
            pairs: Vec::with_capacity(MAX_PAIRS),
        }
    }

    /// Appends to `out` the contacts of the region between the faces at `near` that `scope` asks for, as long as `out` has
    /// room. Faces inside the assembly of their own body are never chosen, and where B's face goes on in another piece
    /// there is no border to touch.
    pub fn region(&mut self, pair: &Pair<'_>, near: &CFace, scope: &Scope, out: &mut Vec<RegionPoint>) {
        let same = same_place(pair);
        let first = out.len();
        // Near's own contact first, at its exact place, when its features face each other.
        let own = if scope.near_felt { facing_point(pair, near, own_tolerance(pair)) } else { None };
        if let Some(point_w) = own.filter(|_| near.distance <= scope.reach) {
            push(RegionPoint::of(near, point_w), (same, !scope.along_near), [first; 2], out);
        }
        self.pairs.clear();
        if scope.wide {
            facing_pairs(pair, near, &mut self.pairs);
        } else {
            self.pairs.extend(most_parallel(pair, near));
            if !scope.along_near {
                pairs_along_edges(pair, near, scope.reach, &mut self.pairs);
            }
        }
        let known = own.map(|_| near.contact);
        for k in 0..self.pairs.len() {
            if let Some(faces) = FacePair::new(pair, self.pairs[k], near.normal_w, scope) {
                self.faces(&faces, known, first, out);
            }
        }
    }

    /// Appends the contacts of the region of `near` that belong to other pairs: where the faces that [`Clipper::region`] finds (with
    /// a wide scope) go on in other pieces of their bodies, as one plane. Only the pairs in `others` are looked at.
    pub fn beside(
        &mut self,
        pair: &Pair<'_>,
        others: &[Sensed],
        near: &CFace,
        scope: &Scope,
        out: &mut Vec<RegionPoint>,
    ) {
        let first = out.len();
        self.pairs.clear();
        facing_pairs(pair, near, &mut self.pairs);
        for s in others {
            let other = pair.solids.of(s, pair.placed);
            if (other.part, other.piece) == (pair.part, pair.piece) {
                continue;
            }
            for k in 0..self.pairs.len() {
                let (face_a, face_b) = self.pairs[k];
                let flush_a = pair.solids.flush_a(pair.part, face_a, other.part);
                let faces = flush_a.zip(pair.solids.flush_b(pair.piece, face_b, other.piece));
                if let Some(faces) = faces.and_then(|f| FacePair::new(&other, f, near.normal_w, scope)) {
                    self.faces(&faces, None, first, out);
                }
            }
        }
    }

    /// Appends the contacts between one face of each body, but for the one that is known: the corners of the region in which they
    /// lie over each other.
    fn faces(&mut self, faces: &FacePair<'_>, known: Option<BasicContact>, first: usize, out: &mut Vec<RegionPoint>) {
        let same = same_place(&faces.pair);
        let ring = out.len();
        let mut add = |corner: Corner, point: DVec3| {
            if let Some(found) = faces.contact(corner, point).filter(|p| known != Some(p.contact)) {
                push(found, (same, !faces.scope.along_near), [first, ring], out);
            }
        };
        self.edges_of_a(faces, same, &mut add);
        // A vertex of B under A's face has something of A beyond both its sides.
        let mut last = self.cuts.last().copied().unwrap_or(false);
        for (j, cuts) in self.cuts.iter().enumerate() {
            if std::mem::replace(&mut last, *cuts)
                && *cuts
                && let Some(point) = faces.over_vertex_of_b(j, self.ring[0], same)
            {
                add(Corner::OfB(j), point);
            }
        }
        if faces.may_look_past() {
            self.past_joints(faces, same, &mut add);
        }
    }

    /// Gives `add` the vertices that stand past a joint of the other face: see [`FacePair::is_past_b`]. After [`Clipper::edges_of_a`].
    #[inline(never)]
    fn past_joints(&self, faces: &FacePair<'_>, same: f64, add: &mut impl FnMut(Corner, DVec3)) {
        let [past_b, past_a] = faces.looks_past();
        if past_b {
            let ring = &self.ring[..self.ring.len() - 1];
            for (i, point) in ring.iter().enumerate().filter(|(_, p)| faces.is_past_b(**p, same)) {
                add(Corner::OfA(i), *point);
            }
        }
        if past_a {
            for j in 0..self.cuts.len() {
                if let Some(point) = faces.past_a(j, self.ring[0], same) {
                    add(Corner::OfB(j), point);
                }
            }
        }
    }

    /// Gives `add` the vertices of A's face that lie over B's face, and where A's edges cross B's: A's edges are cut by the sides
    /// of B's face (Cyrus and Beck 1978).
    fn edges_of_a(&mut self, faces: &FacePair<'_>, same: f64, add: &mut impl FnMut(Corner, DVec3)) {
        let Self { ring, cuts, spans, .. } = self;
        ring.clear();
        ring.extend(faces.ring_a().iter().map(|v| faces.pair.placed.point(faces.pair.a.vertex(*v))));
        let Some(first) = ring.first().copied() else { return };
        spans.clear();
        spans.resize(ring.len(), Span::WHOLE);
        cuts.clear();
        ring.push(first);
        for (j, (outward, offset)) in faces.sides_of_b().enumerate() {
            let beyond = |p: DVec3| outward.dot(p) - offset;
            let mut is_cutting = false;
            let mut start = beyond(first);
            for (span, q) in spans.iter_mut().zip(&ring[1..]) {
                let end = beyond(*q);
                if start > same || end > same {
                    span.cut(j as u32, start, end, same);
                    is_cutting = true;
                }
                start = end;
            }
            cuts.push(is_cutting);
        }
        let mut start = (first, faces.height(first));
        for (i, (span, q)) in spans.iter().zip(&ring[1..]).enumerate() {
            let end = (*q, faces.height(*q));
            let (p, height) = std::mem::replace(&mut start, end);
            if span.is_empty() || height.min(end.1) > faces.highest {
                continue;
            }
            if span.enter.side == Cut::NONE {
                add(Corner::OfA(i), p);
            } else {
                add(Corner::Crossing(i, span.enter.side as usize), p + (*q - p) * span.enter.line);
            }
            if span.leave.side != Cut::NONE {
                add(Corner::Crossing(i, span.leave.side as usize), p + (*q - p) * span.leave.line);
            }
        }
    }
}

/// Keeps a contact unless it is a duplicate of one from `first` on or there is no room; of two at one place the first stays, but
/// where `apart` says that they bound the motion in different directions.
/// From `ring` on they come in the order of a convex polygon's corners: there only neighbours can be at one place.
fn push(p: RegionPoint, (same, apart): (f64, bool), [first, ring]: [usize; 2], out: &mut Vec<RegionPoint>) {
    let there = |o: &RegionPoint| {
        o.point_w.distance_squared(p.point_w) <= same * same
            && !(apart && o.normal_w.distance_squared(p.normal_w) > ONE_DIRECTION * ONE_DIRECTION)
    };
    let known = || {
        out[first..ring].iter().any(there)
            || out[ring..].first().is_some_and(there)
            || out[ring..].last().is_some_and(there)
    };
    if !known() {
        push_within(out, p);
    }
}

/// Keeps a contact if there is room.
pub(crate) fn push_within(points: &mut Vec<RegionPoint>, p: RegionPoint) {
    if points.len() < points.capacity() {
        points.push(p);
    }
}

/// How far outside Near's features may face each other, metres.
pub(crate) fn own_tolerance(pair: &Pair<'_>) -> f64 {
    1e3 * same_place(pair)
}

/// Contacts closer together than this are one, metres.
fn same_place(pair: &Pair<'_>) -> f64 {
    SAME_POINT * (pair.a.size() + pair.b.size())
}

/// The pair of faces, one of each body, at the features of `near` that are most nearly antiparallel.
pub(crate) fn most_parallel(pair: &Pair<'_>, near: &CFace) -> Option<(FaceId, FaceId)> {
    let mut best = (f64::INFINITY, None);
    for_each_pair(pair, near, |cosine, faces| {
        if cosine < best.0 {
            best = (cosine, Some(faces));
        }
    });
    best.1
}

/// The pairs of faces at the features of `near` that face each other: the most nearly antiparallel, and as many others as
/// `out` has room for.
fn facing_pairs(pair: &Pair<'_>, near: &CFace, out: &mut Vec<(FaceId, FaceId)>) {
    out.extend(most_parallel(pair, near));
    for_each_pair(pair, near, |cosine, faces| {
        if cosine < FACING && out.len() < out.capacity() && out.first() != Some(&faces) {
            out.push(faces);
        }
    });
}

/// Adds to the pair of faces that was chosen at two crossing edges those of the other faces there that the other body's edge lies
/// along, within `reach` metres: it crosses their far sides, too, and all these places bound the motion.
fn pairs_along_edges(pair: &Pair<'_>, near: &CFace, reach: f64, out: &mut Vec<(FaceId, FaceId)>) {
    let Pair { solids, a, b, part, piece, placed } = *pair;
    let (BasicContact::TypeC { edge_a, edge_b }, Some(&chosen)) = (near.contact, out.first()) else { return };
    let along_a = placed.r * a.edge_direction(edge_a);
    let along_b = placed.r.transpose() * b.edge_direction(edge_b);
    for face_a in a.edge(edge_a).faces {
        let slope = a.face_plane(face_a).normal.dot(along_b).abs();
        if face_a != chosen.0 && slope * a.size() <= reach && !solids.is_internal_a(part, face_a) {
            out.push((face_a, chosen.1));
        }
    }
    for face_b in b.edge(edge_b).faces {
        let slope = b.face_plane(face_b).normal.dot(along_a).abs();
        if face_b != chosen.1 && slope * b.size() <= reach && !solids.is_internal_b(piece, face_b) {
            out.push((chosen.0, face_b));
        }
    }
}

/// Calls `each` with the pairs of surface faces at the features of `near`, and the cosine between their outward normals.
fn for_each_pair(pair: &Pair<'_>, near: &CFace, mut each: impl FnMut(f64, (FaceId, FaceId))) {
    let Pair { solids, a, b, part, piece, placed } = *pair;
    let (one_a, one_b);
    let (edge_a_faces, edge_b_faces);
    let (faces_a, faces_b): (&[FaceId], &[FaceId]) = match near.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            one_b = [face_b];
            (a.vertex_faces(vertex_a), &one_b)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            one_a = [face_a];
            (&one_a, b.vertex_faces(vertex_b))
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            (edge_a_faces, edge_b_faces) = (a.edge(edge_a).faces, b.edge(edge_b).faces);
            (&edge_a_faces, &edge_b_faces)
        }
    };
    let (covers_a, covers_b) = (solids.moving.covers(part), solids.fixed.covers(piece));
    for i in faces_a.iter().filter(|f| covers_a[f.index()] != Cover::Internal) {
        let normal = placed.r * a.face_plane(*i).normal;
        for j in faces_b.iter().filter(|f| covers_b[f.index()] != Cover::Internal) {
            each(b.face_plane(*j).normal.dot(normal), (*i, *j));
        }
    }
}
