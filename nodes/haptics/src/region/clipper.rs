//! The contact region of a pair: the two faces in contact, clipped against each other, as basic contacts.

use crate::region::face_pair::{Corner, FacePair};
use crate::region::facing_faces::{facing_pairs, most_parallel, pairs_along_edges};
use crate::region::point::{RegionPoint, Scope, own_tolerance, push_within, same_place};
use crate::region::span::{Cut, Span};
use crate::solid::{Pair, Sensed, facing_point};
use cspace::{BasicContact, CFace, FaceId, Polyhedron, World};
use spatial::DVec3;

/// Scratch for clipping; grows at construction only.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clipper {
    /// The vertices of A's face, W, and the first again.
    ring: Vec<DVec3>,
    /// Which sides of B's face have something of A's face beyond them.
    cuts: Vec<bool>,
    /// Of each edge of A's face, which leaves the vertex of the same index.
    spans: Vec<Span>,
    /// The pairs of faces of the region, in the order in which they were come by.
    pairs: Vec<(FaceId, FaceId)>,
    /// The same of other pairs of bodies.
    others: Vec<(Other, FaceId, FaceId)>,
}

/// Which of the other pairs of bodies that were sensed; none for the pair in hand.
type Other = Option<u32>;

/// Normals that differ by less, radians, bound one motion.
const ONE_DIRECTION: f64 = 1e-4;
/// Most pairs of faces clipped for one contact.
const MAX_PAIRS: usize = 24;

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
            others: Vec::with_capacity(MAX_PAIRS),
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
            let sharpness = if scope.wide { own_sharpness(pair, near, point_w, scope) } else { 1.0 };
            let found = RegionPoint { sharpness, ..RegionPoint::of(near, point_w) };
            push(found, (same, lead(near.normal_w, scope)), [first; 2], out);
        }
        self.start(pair, near, scope);
        let known = own.map(|_| near.contact);
        let mut pairs = std::mem::take(&mut self.pairs);
        let mut k = 0;
        while let Some(found) = pairs.get(k) {
            if let Some(faces) = FacePair::new(pair, *found, near.normal_w, scope) {
                self.faces(&faces, known, first, out, |f| keep(&mut pairs, f));
            }
            k += 1;
        }
        self.pairs = pairs;
    }

    /// Takes the pairs of faces at Near's features, from which the region goes on to others.
    pub fn start(&mut self, pair: &Pair<'_>, near: &CFace, scope: &Scope) {
        self.pairs.clear();
        if scope.wide {
            facing_pairs(pair, near, &mut self.pairs);
        } else {
            self.pairs.extend(most_parallel(pair, near));
            let reach = if scope.along_near { scope.reach - near.distance } else { scope.reach };
            pairs_along_edges(pair, near, reach, &mut self.pairs);
        }
    }

    /// Appends the contacts of the region of `near` that belong to other pairs of bodies: where the faces of the last
    /// [`Clipper::region`] (or [`Clipper::start`], where one contact is all of it) go on in other pieces of their bodies, as one
    /// plane, and from there to others. Only the pairs in `others` are looked at.
    pub fn beside(
        &mut self,
        pair: &Pair<'_>,
        others: &[Sensed],
        near: &CFace,
        scope: &Scope,
        out: &mut Vec<RegionPoint>,
    ) {
        let first = out.len();
        let solids = pair.solids;
        let mut found = std::mem::take(&mut self.others);
        found.clear();
        found.extend(self.pairs.iter().map(|(a, b)| (None, *a, *b)));
        let mut k = 0;
        while let Some(&(other, face_a, face_b)) = found.get(k) {
            k += 1;
            let here = other.map_or(*pair, |s| Pair::of(solids, &others[s as usize], pair.placed));
            if other.is_some()
                && let Some(faces) = FacePair::new(&here, (face_a, face_b), near.normal_w, scope)
            {
                self.faces(&faces, None, first, out, |(a, b)| keep(&mut found, (other, a, b)));
            }
            for (s, there) in others.iter().enumerate() {
                let (part, piece) = (there.part as usize, there.piece as usize);
                if (part, piece) != (here.part, here.piece)
                    && (part, piece) != (pair.part, pair.piece)
                    && let Some(a) = solids.flush_a(here.part, face_a, part)
                    && let Some(b) = solids.flush_b(here.piece, face_b, piece)
                {
                    keep(&mut found, (Some(s as u32), a, b));
                }
            }
        }
        self.others = found;
    }

    /// Appends the contacts between one face of each body, but for the one that is known: the corners of the region in which they
    /// lie over each other.
    /// Gives `go_on` the pairs of faces in which the region goes on.
    fn faces(
        &mut self,
        faces: &FacePair<'_>,
        known: Option<BasicContact>,
        first: usize,
        out: &mut Vec<RegionPoint>,
        mut go_on: impl FnMut((FaceId, FaceId)),
    ) {
        let same = same_place(&faces.pair);
        let ring = out.len();
        let goes_on = faces.may_go_on();
        let lead = lead(faces.near_w, &faces.scope);
        let mut add = |corner: Corner, point: DVec3| {
            if goes_on {
                faces.each_beyond(corner, point, same, &mut go_on);
            }
            if let Some(found) = faces.contact(corner, point).filter(|p| known != Some(p.contact)) {
                push(found, (same, lead), [first, ring], out);
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
        if faces.scope.wide {
            let Pair { solids, part, piece, .. } = faces.pair;
            for p in &mut out[ring..] {
                p.sharpness = solids.sharpness(part, piece, p.contact);
            }
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

/// Near's normal, if contacts at one place may bound the motion in different directions.
fn lead(near_w: DVec3, scope: &Scope) -> Option<DVec3> {
    (!scope.along_near).then_some(near_w)
}

/// Keeps a contact unless one from `first` on stands for it or there is no room: see [`stands_for`].
/// From `ring` on they come in the order of a convex polygon's corners: there only neighbours can be at one place.
fn push(p: RegionPoint, (same, lead): (f64, Option<DVec3>), [first, ring]: [usize; 2], out: &mut Vec<RegionPoint>) {
    let known = |o: &mut RegionPoint| stands_for(o, &p, same, lead);
    let is_known = out[first..ring].iter_mut().any(known)
        || out[ring..].first_mut().is_some_and(known)
        || out[ring..].last_mut().is_some_and(known);
    if !is_known {
        push_within(out, p);
    }
}

/// Whether of two contacts at one place `p` is not to be kept. Seen along their own normals they may bound the motion in different
/// directions: then the body is free on either's side, and the one nearer to the lead stays, as `o`; the other belongs to the region
/// of another plane. Both together would hold a corner that goes over a rim there, and let go of it at once.
fn stands_for(o: &mut RegionPoint, p: &RegionPoint, same: f64, lead: Option<DVec3>) -> bool {
    if o.point_w.distance_squared(p.point_w) > same * same {
        return false;
    }
    if let Some(lead) = lead
        && o.normal_w.distance_squared(p.normal_w) > ONE_DIRECTION * ONE_DIRECTION
        && p.normal_w.distance_squared(lead) < o.normal_w.distance_squared(lead)
    {
        *o = *p;
    }
    true
}

/// How much of a contact Near's own is, 0 to 1, at `point_w` on B.
fn own_sharpness(pair: &Pair<'_>, near: &CFace, point_w: DVec3, scope: &Scope) -> f32 {
    let Pair { solids, part, piece, .. } = *pair;
    let at = [point_w + near.normal_w * near.distance, point_w];
    let is_cut = !solids.is_seamless(part, piece)
        && most_parallel(pair, near)
            .and_then(|f| FacePair::new(pair, f, near.normal_w, scope))
            .is_some_and(|f| f.is_cut(near.contact, at));
    if is_cut { 0.0 } else { solids.sharpness(part, piece, near.contact) }
}

/// Keeps what is new if there is room.
fn keep<T: PartialEq>(list: &mut Vec<T>, new: T) {
    if list.len() < list.capacity() && !list.contains(&new) {
        list.push(new);
    }
}
