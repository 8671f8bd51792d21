//! The contact region of a pair: the two faces in contact, clipped against each other, as basic contacts.

use crate::facing::facing_point;
use crate::sense::Sensed;
use crate::solid::Solids;
use cspace::{BasicContact, CFace, EdgeId, FaceId, Polyhedron, World};
use spatial::{DMat3, DVec3, Pose};

/// A basic contact of the region: one of the paper's K contacts when it takes place, a potential one when it has a gap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionPoint {
    pub contact: BasicContact,
    /// App_k, metres, W: on the surface of B.
    pub point_w: DVec3,
    /// Unit, axes of W, from B to A.
    pub normal_w: DVec3,
    /// Signed distance of A to B at this contact along the normal, metres; `< 0` is penetration.
    pub gap: f64,
    /// From `point_w` to A's point of the contact, metres, axes of W.
    pub span_w: DVec3,
}

impl RegionPoint {
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

/// The pose of A in the form the geometry wants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub x: DVec3,
    pub r: DMat3,
}

impl Placed {
    pub fn new(pose: &Pose) -> Self {
        Self { x: pose.translation, r: pose.rotation_matrix() }
    }

    /// The same orientation, moved by `by`, axes of W.
    pub fn shifted(&self, by: DVec3) -> Self {
        Self { x: self.x + by, r: self.r }
    }

    pub fn point(&self, p: DVec3) -> DVec3 {
        self.x + self.r * p
    }

    /// A point of W as A sees it.
    pub fn seen_from_a(&self, p: DVec3) -> DVec3 {
        self.r.transpose() * (p - self.x)
    }
}

/// Where an edge of the clipped polygon comes from: position in the ring of A's or of B's face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    A(u16),
    B(u16),
}

#[derive(Clone, Copy, Debug)]
struct Corner {
    point: DVec3,
    /// The origin of the edge that leaves this corner.
    leaving: Side,
}

/// Which contacts of a region are wanted, and seen in which direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scope {
    /// Contacts with a gap of up to this, metres.
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
    subject: Vec<Corner>,
    result: Vec<Corner>,
    /// How far each corner of the subject lies beyond the side in hand, metres.
    beyond: Vec<f64>,
    pairs: Vec<(FaceId, FaceId)>,
}

/// Contacts closer together than this part of the size are one.
const SAME_POINT: f64 = 1e-8;
/// Most pairs of faces clipped for one contact, and the cosine up to which they count as facing each other.
const MAX_PAIRS: usize = 8;
const FACING: f64 = -0.5;
/// Edges that cross at less than this angle (radians) have no reliable common normal: the face's is used.
const PARALLEL_EDGES: f64 = 0.02;

impl Clipper {
    /// Room for the largest faces of the world.
    pub fn for_world(world: &World) -> Self {
        let most = |p: &Polyhedron| p.faces().map(|f| p.face_vertices(f).len()).max().unwrap_or(0);
        let a = world.moving.iter().map(|p| most(p)).max().unwrap_or(0);
        let b = world.fixed.iter().map(|p| most(&p.polyhedron)).max().unwrap_or(0);
        // A convex polygon gains at most one corner per clipping line; rounding is allowed as much again.
        let room = 2 * (a + b) + 8;
        Self {
            subject: Vec::with_capacity(room),
            result: Vec::with_capacity(room),
            beyond: Vec::with_capacity(room),
            pairs: Vec::with_capacity(MAX_PAIRS),
        }
    }

    /// Appends to `out` the contacts of the region between the faces at `near` that `scope` asks for, as long as `out` has
    /// room. Faces inside the assembly of their own body are never chosen, and where B's face goes on in another piece
    /// there is no border to touch.
    #[expect(clippy::too_many_arguments, reason = "one call site each; a struct would only rename them")]
    pub fn region(
        &mut self,
        solids: &Solids,
        part: usize,
        piece: usize,
        placed: &Placed,
        near: &CFace,
        scope: &Scope,
        out: &mut Vec<RegionPoint>,
    ) {
        let (a, b) = (solids.part(part), solids.piece(piece));
        let same = SAME_POINT * (a.size() + b.size());
        let first = out.len();
        // Near's own contact first, at its exact place, when its features face each other.
        let own = if scope.near_felt { facing_point(a, b, placed, near, 1e3 * same) } else { None };
        if let Some(point_w) = own.filter(|_| near.distance <= scope.reach) {
            let (gap, normal_w) = (near.distance, near.normal_w);
            let own = RegionPoint { contact: near.contact, point_w, normal_w, gap, span_w: normal_w * gap };
            push(own, same, [first; 2], out);
        }
        self.pairs.clear();
        if scope.wide {
            facing_pairs(solids, part, piece, &placed.r, near, &mut self.pairs);
        } else {
            self.pairs.extend(most_parallel(solids, part, piece, &placed.r, near));
        }
        for k in 0..self.pairs.len() {
            let (face_a, face_b) = self.pairs[k];
            self.faces(solids, part, piece, placed, near, own.is_some(), (face_a, face_b), scope, first, out);
        }
    }

    /// Appends the contacts of the region of `near` that belong to other pairs: where the faces that [`Clipper::region`] finds (with
    /// a wide scope) go on in other pieces of their bodies, as one plane. Only the pairs in `others` are looked at.
    #[expect(clippy::too_many_arguments, reason = "one call site; a struct would only rename them")]
    pub fn beside(
        &mut self,
        solids: &Solids,
        others: &[Sensed],
        (part, piece): (usize, usize),
        placed: &Placed,
        near: &CFace,
        scope: &Scope,
        first: usize,
        out: &mut Vec<RegionPoint>,
    ) {
        self.pairs.clear();
        facing_pairs(solids, part, piece, &placed.r, near, &mut self.pairs);
        for s in others {
            let (other_a, other_b) = (s.part as usize, s.piece as usize);
            if (other_a, other_b) == (part, piece) {
                continue;
            }
            for k in 0..self.pairs.len() {
                let (face_a, face_b) = self.pairs[k];
                let faces = solids.flush_a(part, face_a, other_a).zip(solids.flush_b(piece, face_b, other_b));
                if let Some(faces) = faces {
                    self.faces(solids, other_a, other_b, placed, near, false, faces, scope, first, out);
                }
            }
        }
    }

    /// Appends the contacts between one face of each body.
    #[expect(clippy::too_many_arguments, reason = "one call site; a struct would only rename them")]
    fn faces(
        &mut self,
        solids: &Solids,
        part: usize,
        piece: usize,
        placed: &Placed,
        near: &CFace,
        own: bool,
        (face_a, face_b): (FaceId, FaceId),
        scope: &Scope,
        first: usize,
        out: &mut Vec<RegionPoint>,
    ) {
        let (a, b) = (solids.part(part), solids.piece(piece));
        let same = SAME_POINT * (a.size() + b.size());
        let plane_b = b.face_plane(face_b);
        let normal_a = -(placed.r * a.face_plane(face_a).normal);
        let lean = normal_a.dot(plane_b.normal);
        let along = if scope.along_near { near.normal_w } else { plane_b.normal };
        let slope = along.dot(plane_b.normal);
        if lean > 0.1 && slope > 0.1 && along.dot(normal_a) > 0.1 {
            self.clip(a, face_a, b, face_b, placed, along, same);
            let ring = out.len();
            let ring_a = (a.face_vertices(face_a), a.face_edges(face_a));
            let ring_b = (b.face_vertices(face_b), b.face_edges(face_b));
            let mut last = self.subject.last().map_or(Side::A(0), |c| c.leaving);
            for &Corner { point, leaving } in &self.subject {
                let before = std::mem::replace(&mut last, leaving);
                // Weighted by their depths, the ends of a cut in A's face would count as contacts.
                let cut = |s: &Side| match s {
                    Side::A(i) => solids.goes_on_a(part, face_a, *i as usize, point, placed),
                    Side::B(_) => false,
                };
                if scope.wide && (cut(&before) || cut(&leaving)) {
                    continue;
                }
                let height = plane_b.signed_distance(point);
                if height * lean > scope.reach && height > scope.reach {
                    continue;
                }
                let span_w = along * (height / slope);
                let foot = point - span_w;
                let found = match (before, leaving) {
                    (Side::A(_), Side::A(i)) => RegionPoint {
                        contact: BasicContact::TypeB { vertex_a: ring_a.0[i as usize], face_b },
                        point_w: foot,
                        normal_w: plane_b.normal,
                        gap: height,
                        span_w,
                    },
                    (Side::B(i), Side::B(j)) => {
                        // The corner that the two sides share; A's ring runs against B's, so they come in either order.
                        let n = ring_b.0.len();
                        let (i, j) = (i as usize, j as usize);
                        let corner = if i + 1 == j || i + 1 == n && j == 0 { j } else { i };
                        let at = b.vertex(ring_b.0[corner]);
                        if i == j || [i, j].iter().any(|s| solids.goes_on_b(piece, face_b, *s, at)) {
                            continue;
                        }
                        RegionPoint {
                            contact: BasicContact::TypeA { face_a, vertex_b: ring_b.0[corner] },
                            point_w: at,
                            normal_w: normal_a,
                            gap: height * lean,
                            span_w,
                        }
                    }
                    (Side::A(i), Side::B(j)) | (Side::B(j), Side::A(i)) => {
                        if solids.goes_on_b(piece, face_b, j as usize, foot) {
                            continue;
                        }
                        let (edge_a, edge_b) = (ring_a.1[i as usize], ring_b.1[j as usize]);
                        let (normal_w, gap) = crossing(a, edge_a, b, edge_b, &placed.r, plane_b.normal, height);
                        RegionPoint {
                            contact: BasicContact::TypeC { edge_a, edge_b },
                            point_w: foot,
                            normal_w,
                            gap,
                            span_w,
                        }
                    }
                };
                if found.gap <= scope.reach && (!own || found.contact != near.contact) {
                    push(found, same, [first, ring], out);
                }
            }
        }
    }

    /// A's face, cut by the sides of B's face (Sutherland and Hodgman 1974) seen in the direction `sight`; left in `subject`.
    /// The corners lie on A's face.
    #[expect(clippy::too_many_arguments, reason = "one call site; a struct would only rename them")]
    fn clip(
        &mut self,
        a: &Polyhedron,
        face_a: FaceId,
        b: &Polyhedron,
        face_b: FaceId,
        placed: &Placed,
        sight: DVec3,
        same: f64,
    ) {
        self.subject.clear();
        for (i, v) in a.face_vertices(face_a).iter().enumerate() {
            self.subject.push(Corner { point: placed.point(a.vertex(*v)), leaving: Side::A(i as u16) });
        }
        let plane_b = b.face_plane(face_b);
        let upright = plane_b.normal.dot(sight);
        for (j, side) in b.face_sides(face_b).iter().enumerate() {
            // The plane through the same edge and along the sight.
            let lean = side.normal.dot(sight);
            let outward = side.normal * upright - plane_b.normal * lean;
            let offset = side.distance * upright - plane_b.distance * lean + same;
            self.beyond.clear();
            self.beyond.extend(self.subject.iter().map(|c| outward.dot(c.point) - offset));
            if self.beyond.iter().all(|h| *h <= 0.0) {
                continue;
            }
            self.result.clear();
            for k in 0..self.subject.len() {
                let next = if k + 1 < self.subject.len() { k + 1 } else { 0 };
                let (p, q) = (self.subject[k], self.subject[next]);
                let (hp, hq) = (self.beyond[k], self.beyond[next]);
                // Where the side's own line is crossed, which lies `same` within what still counts as inside.
                let cut = || p.point + (q.point - p.point) * ((hp + same) / (hp - hq)).clamp(0.0, 1.0);
                if self.result.len() + 2 > self.result.capacity() {
                    break;
                }
                match (hp <= 0.0, hq <= 0.0) {
                    (true, true) => self.result.push(p),
                    (true, false) => {
                        self.result.push(p);
                        self.result.push(Corner { point: cut(), leaving: Side::B(j as u16) });
                    }
                    (false, true) => self.result.push(Corner { point: cut(), leaving: p.leaving }),
                    (false, false) => {}
                }
            }
            std::mem::swap(&mut self.subject, &mut self.result);
            if self.subject.is_empty() {
                return;
            }
        }
    }
}

/// Keeps a contact unless it is a duplicate of one from `first` on or there is no room; of two at one place the first stays.
/// From `ring` on they come in the order of a convex polygon's corners: there only neighbours can be at one place.
fn push(p: RegionPoint, same: f64, [first, ring]: [usize; 2], out: &mut Vec<RegionPoint>) {
    let there = |o: &RegionPoint| o.point_w.distance_squared(p.point_w) <= same * same;
    let known = || {
        out[first..ring].iter().any(there)
            || out[ring..].first().is_some_and(there)
            || out[ring..].last().is_some_and(there)
    };
    if out.len() < out.capacity() && !known() {
        out.push(p);
    }
}

/// The pair of faces, one of each body, at the features of `near` that are most nearly antiparallel.
pub(crate) fn most_parallel(
    solids: &Solids,
    part: usize,
    piece: usize,
    r: &DMat3,
    near: &CFace,
) -> Option<(FaceId, FaceId)> {
    let mut best = (f64::INFINITY, None);
    for_each_pair(solids, part, piece, r, near, |cosine, faces| {
        if cosine < best.0 {
            best = (cosine, Some(faces));
        }
    });
    best.1
}

/// The pairs of faces at the features of `near` that face each other: the most nearly antiparallel, and as many others as
/// `out` has room for.
fn facing_pairs(solids: &Solids, part: usize, piece: usize, r: &DMat3, near: &CFace, out: &mut Vec<(FaceId, FaceId)>) {
    out.extend(most_parallel(solids, part, piece, r, near));
    for_each_pair(solids, part, piece, r, near, |cosine, faces| {
        if cosine < FACING && out.len() < out.capacity() && out.first() != Some(&faces) {
            out.push(faces);
        }
    });
}

/// Calls `each` with the pairs of surface faces at the features of `near`, and the cosine between their outward normals.
fn for_each_pair(
    solids: &Solids,
    part: usize,
    piece: usize,
    r: &DMat3,
    near: &CFace,
    mut each: impl FnMut(f64, (FaceId, FaceId)),
) {
    let (a, b) = (solids.part(part), solids.piece(piece));
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
    for i in faces_a.iter().filter(|f| !solids.is_internal_a(part, **f)) {
        let normal = *r * a.face_plane(*i).normal;
        for j in faces_b.iter().filter(|f| !solids.is_internal_b(piece, **f)) {
            each(b.face_plane(*j).normal.dot(normal), (*i, *j));
        }
    }
}

/// Normal and gap of two crossing edges whose vertical distance above B's face is `height`.
fn crossing(
    a: &Polyhedron,
    edge_a: EdgeId,
    b: &Polyhedron,
    edge_b: EdgeId,
    r: &DMat3,
    normal_b: DVec3,
    height: f64,
) -> (DVec3, f64) {
    let n = (*r * a.edge_direction(edge_a)).cross(b.edge_direction(edge_b));
    let length = n.length();
    if length <= PARALLEL_EDGES {
        return (normal_b, height);
    }
    let lean = n.dot(normal_b) / length;
    if lean.abs() < 0.1 {
        return (normal_b, height);
    }
    (n * (lean.signum() / length), height * lean.abs())
}
