//! What the proxy sees around it: the contacts of all pairs in reach, and how deep it penetrates.

use crate::formation::{ContactFormation, ContactPoint, FormationKind};
use crate::proxy::step::Step;
use crate::region::{Clipper, RegionPoint, Scope, most_parallel, push_within};
use crate::solid::{Covered, OnePlane, Pair, Placed, Sense, Sensed, Solids, TURN, each_hollow_end};
use cspace::{BasicContact, CFace};
use spatial::{DVec3, Pose};

/// Penetration of the proxy that counts as none, metres.
pub(crate) const PENETRATION: f64 = 1e-8;
/// A contact takes place from this gap on and ends at the larger one, metres: the formation does not chatter.
const TOUCHING: f64 = 1e-7;
const LEAVING: f64 = 5e-7;
/// A contact with a gap beyond this stays as it was seen while the proxy takes steps too small to look anew, metres.
const OPEN: f64 = 1e-6;
/// A felt plane of a piece whose nearest plane is a seam counts while it is violated by no more than this, metres.
const BESIDE: f64 = 1e-6;
/// C-faces of a pair whose signed distances at the proxy are within this of nought meet there, metres.
const TIE: f64 = 1e-9;
/// A motion within which no C-face ties is known no farther than this, metres.
const UNTIED: f64 = 1e-3;
/// Most planes of pairs that are replaced together.
const TOGETHER: usize = 8;
/// Bounds of the reach, metres.
const SHORTEST: f64 = 2e-4;
const LONGEST: f64 = 3e-3;
/// A motion of the hand in one tick beyond this, or half the lever, is a jump and no motion, metres.
const JUMP: f64 = 0.05;

/// A pair in reach and its contacts in the list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InReach {
    pub part: u32,
    pub piece: u32,
    pub first: usize,
    pub end: usize,
    /// The plane whose region is listed.
    pub plane: CFace,
    /// See [`Scope::near_felt`].
    felt: bool,
}

/// Pairs whose planes were replaced together, as they were before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Replaced {
    old: [InReach; TOGETHER],
    count: usize,
    /// How many of them were listed before the one that was asked for.
    pub before: usize,
}

/// A plane that no other ties with while the proxy stays near a pose: within `room` (metres) and `turn` (radians).
#[derive(Clone, Copy, Debug)]
struct Untied {
    contact: BasicContact,
    at: Pose,
    room: f64,
    turn: f64,
}

impl Untied {
    fn holds(&self, contact: BasicContact, pose: &Pose, lever: f64) -> bool {
        // |q - q0| = 2 sin(angle / 4).
        let turn = 2.1 * (pose.rotation - self.at.rotation).length();
        self.contact == contact
            && turn <= self.turn
            && (pose.translation - self.at.translation).length() + lever * turn < self.room
    }
}

/// Contacts seen from the proxy.
#[derive(Debug)]
pub(crate) struct View {
    pub sense: Sense,
    pub points: Vec<RegionPoint>,
    pub pairs: Vec<InReach>,
    /// The deepest penetration at the proxy, metres; `<= 0` when free.
    pub penetration: f64,
    /// No contact with a larger gap is ever listed, and no step of the proxy is longer (metres).
    pub reach: f64,
    /// Contacts with larger gaps were not listed at the last look, metres.
    listed: f64,
    /// A motion of the hand in one tick beyond this is a jump, metres.
    pub jump: f64,
    /// Farthest point of A from its origin, metres.
    pub lever: f64,
    clipper: Clipper,
    /// For each pair whether contacts took place in this tick and in the one before.
    touching: Vec<bool>,
    touched: Vec<bool>,
    /// For each pair the plane last felt where Near is a seam.
    hints: Vec<Option<BasicContact>>,
    /// For each pair what is known of planes that tie.
    untied: Vec<Option<Untied>>,
    /// For each pair the last nearest plane that was felt.
    last_felt: Vec<Option<BasicContact>>,
    /// Pairs whose nearest plane at this look is a seam.
    unfelt: Vec<bool>,
    places: Vec<DVec3>,
    pieces: usize,
}

impl View {
    /// Most contacts listed.
    pub const ROOM: usize = 160;

    pub fn new(solids: &Solids) -> Self {
        let world = &solids.world;
        let thin = |it: &mut dyn Iterator<Item = f64>| it.fold(f64::INFINITY, f64::min);
        let part = thin(&mut world.moving.iter().map(|p| p.inner_radius()));
        let piece = thin(&mut world.fixed.iter().map(|p| p.polyhedron.inner_radius()));
        // A C-obstacle is as thick as its two bodies together; a quarter of that cannot jump from one side to the other.
        let thickness = 2.0 * (part + piece);
        let reach = if thickness.is_finite() { (0.25 * thickness).clamp(SHORTEST, LONGEST) } else { LONGEST };
        let lever = solids.lever();
        let pairs = world.moving.len() * world.fixed.len();
        Self {
            sense: Sense::new(world.clone(), reach),
            points: Vec::with_capacity(Self::ROOM),
            // A pair may be listed by its region and by its hollow ends.
            pairs: Vec::with_capacity(2 * pairs),
            penetration: 0.0,
            reach,
            listed: reach,
            jump: JUMP.max(0.5 * lever),
            lever,
            clipper: Clipper::for_world(world),
            touching: vec![false; pairs],
            touched: vec![false; pairs],
            hints: vec![None; pairs],
            untied: vec![None; pairs],
            last_felt: vec![None; pairs],
            unfelt: Vec::with_capacity(pairs),
            places: Vec::with_capacity(Self::ROOM),
            pieces: world.fixed.len(),
        }
    }

    pub fn reset(&mut self) {
        self.sense.reset();
        self.touching.fill(false);
        self.hints.fill(None);
        self.untied.fill(None);
        self.last_felt.fill(None);
    }

    /// Whether every contact that a step of this length (metres) may lead to is listed.
    pub fn is_listed(&self, way: f64) -> bool {
        // The points where contacts lie are a little farther from the part's origin than the part's own.
        1.1 * way <= self.listed || self.listed >= self.reach
    }

    /// Looks around from `pose` for contacts with gaps of up to `within`, metres.
    pub fn look(&mut self, solids: &Solids, pose: &Pose, within: f64) {
        self.listed = within.min(self.reach);
        self.sense.step_within(pose, self.listed);
        let placed = Placed::new(pose);
        self.points.clear();
        self.pairs.clear();
        self.penetration = f64::NEG_INFINITY;
        for s in &self.sense.pairs {
            // Inside a piece is penetration whether or not the plane is felt; f > 0 of any plane proves freedom.
            self.penetration = self.penetration.max(-s.near.distance);
        }
        let mut felt_penetration = f64::NEG_INFINITY;
        let mut unfelt = false;
        self.unfelt.clear();
        self.unfelt.resize(self.sense.pairs.len(), false);
        for k in 0..self.sense.pairs.len() {
            let s = self.sense.pairs[k];
            if Pair::of(solids, &s, &placed).is_felt(&s.near, Covered::Unfelt) {
                felt_penetration = felt_penetration.max(-s.near.distance);
                self.last_felt[s.part as usize * self.pieces + s.piece as usize] = Some(s.near.contact);
                self.list(solids, s.part, s.piece, &s.near, true, &placed);
            } else if s.near.distance > -PENETRATION && self.leans_on_open_face(solids, &s, &placed) {
                // Only the place is a seam's: the faces there, and so the region, are the solid's own.
                self.list(solids, s.part, s.piece, &s.near, false, &placed);
                self.list_hollow_ends(solids, &s, &placed);
            } else {
                self.unfelt[k] = true;
                unfelt = true;
            }
        }
        if !unfelt {
            return;
        }
        for k in 0..self.sense.pairs.len() {
            let s = self.sense.pairs[k];
            if !self.unfelt[k] {
                continue;
            }
            let pair = Pair::of(solids, &s, &placed);
            let hint = &mut self.hints[pair.part * self.pieces + pair.piece];
            let plane = pair.felt_plane(&s.near, Covered::Unfelt, hint);
            let is_beside = plane.is_some_and(|p| p.distance >= -BESIDE);
            if !is_beside && self.list_hollow_ends(solids, &s, &placed) {
                continue;
            }
            // A plane far inside belongs to the other side of the solid: the pieces around push out first.
            if let Some(plane) = plane
                && (is_beside || felt_penetration <= PENETRATION && s.near.distance < -PENETRATION)
            {
                self.list(solids, s.part, s.piece, &plane, true, &placed);
            }
        }
    }

    /// See [`each_hollow_end`]. Whether there is any.
    fn list_hollow_ends(&mut self, solids: &Solids, s: &Sensed, placed: &Placed) -> bool {
        let first = self.points.len();
        let points = &mut self.points;
        let pair = Pair::of(solids, s, placed);
        let last = self.last_felt[pair.part * self.pieces + pair.piece];
        each_hollow_end(&pair, &s.near, last, (-BESIDE, self.listed), |plane, at| {
            push_within(points, RegionPoint::of(&plane, at));
        });
        let end = self.points.len();
        if end > first {
            self.pairs.push(InReach { part: s.part, piece: s.piece, first, end, plane: s.near, felt: false });
        }
        end > first
    }

    /// Whether a face of the solid at Near's features stands across Near's normal.
    fn leans_on_open_face(&self, solids: &Solids, s: &Sensed, placed: &Placed) -> bool {
        let pair = Pair::of(solids, s, placed);
        most_parallel(&pair, &s.near)
            .is_some_and(|(_, face_b)| pair.b.face_plane(face_b).normal.dot(s.near.normal_w) > 0.9)
    }

    fn list(&mut self, solids: &Solids, part: u32, piece: u32, plane: &CFace, felt: bool, placed: &Placed) {
        let first = self.points.len();
        let scope = Scope { reach: self.listed, near_felt: felt, wide: false, along_near: false };
        self.clipper.region(&Pair::new(solids, part, piece, placed), plane, &scope, &mut self.points);
        self.pairs.push(InReach { part, piece, first, end: self.points.len(), plane: *plane, felt });
    }

    /// The plane of another C-face that meets the `k`-th pair's at the proxy, which is at `pose`.
    pub fn tied_plane(&mut self, solids: &Solids, k: usize, pose: &Pose, placed: &Placed) -> Option<CFace> {
        self.plane_tied_within(TIE, solids, k, pose, placed)
    }

    /// The same of planes whose signed distances are within `tie` metres of nought.
    fn plane_tied_within(
        &mut self,
        tie: f64,
        solids: &Solids,
        k: usize,
        pose: &Pose,
        placed: &Placed,
    ) -> Option<CFace> {
        let pair = &self.pairs[k];
        let untied = &mut self.untied[pair.part as usize * self.pieces + pair.piece as usize];
        let touches = (-PENETRATION.max(tie)..=tie).contains(&pair.plane.distance);
        if !touches || tie <= TIE && untied.is_some_and(|u| u.holds(pair.plane.contact, pose, self.lever)) {
            return None;
        }
        let (contact, bodies) = (pair.plane.contact, Pair::new(solids, pair.part, pair.piece, placed));
        let (tied, room) = bodies.tied_plane(&pair.plane, tie, UNTIED);
        let turn = TURN / (1.0 + bodies.leverage(contact));
        *untied = (room > 0.0).then_some(Untied { contact, at: *pose, room, turn });
        tied
    }

    /// Lists the contacts of the `k`-th pair for this plane instead, last of all, and likewise of the pairs that have the same two
    /// planes: of the pieces that a wall is cut into, one alone that gives way frees nothing.
    pub fn replace_wall(&mut self, solids: &Solids, k: usize, plane: &CFace, pose: &Pose, placed: &Placed) -> Replaced {
        let wall = self.pairs[k].plane;
        let mut replaced = Replaced { old: [self.pairs[k]; TOGETHER], count: 1, before: 0 };
        self.replace(solids, k, plane, true, placed);
        let mut i = 0;
        for _ in 0..self.pairs.len() - 1 {
            let pair = self.pairs[i];
            let same_wall = replaced.count < TOGETHER && OnePlane::WALL.holds_for(&pair.plane, &wall);
            let tied =
                same_wall.then(|| self.plane_tied_within(OnePlane::WALL.offsets, solids, i, pose, placed)).flatten();
            let Some(tied) = tied.filter(|tied| OnePlane::WALL.holds_for(tied, plane)) else {
                i += 1;
                continue;
            };
            self.replace(solids, i, &tied, true, placed);
            replaced.old[replaced.count] = pair;
            replaced.count += 1;
            replaced.before += usize::from(i < k - replaced.before);
        }
        replaced
    }

    /// Takes back the last [`View::replace_wall`].
    pub fn restore(&mut self, solids: &Solids, replaced: &Replaced, placed: &Placed) {
        for old in &replaced.old[..replaced.count] {
            self.replace(solids, self.pairs.len() - replaced.count, &old.plane, old.felt, placed);
        }
    }

    /// Lists the contacts of the `k`-th pair for this plane instead, last of all.
    fn replace(&mut self, solids: &Solids, k: usize, plane: &CFace, felt: bool, placed: &Placed) {
        let old = self.pairs.remove(k);
        let count = old.end - old.first;
        self.points[old.first..].rotate_left(count);
        self.points.truncate(self.points.len() - count);
        for pair in self.pairs.iter_mut().filter(|p| p.first >= old.end) {
            pair.first -= count;
            pair.end -= count;
        }
        self.list(solids, old.part, old.piece, plane, felt, placed);
    }

    /// Moves the contacts along with a small step to `pose`, to first order: those that so small steps can close.
    pub fn shift(&mut self, solids: &Solids, step: &Step, pose: &Pose) {
        let (mut before, mut deepest) = (f64::INFINITY, f64::INFINITY);
        let mut pairs = self.pairs.iter();
        let mut pair = pairs.next();
        let r = pose.rotation_matrix();
        for (k, p) in self.points.iter_mut().enumerate() {
            while pair.is_some_and(|q| k >= q.end) {
                pair = pairs.next();
            }
            if p.gap > OPEN {
                continue;
            }
            let motion = step.dp + step.dtheta.cross(p.point_w - pose.translation);
            before = before.min(p.gap);
            p.gap += p.normal_w.dot(motion);
            match p.contact {
                BasicContact::TypeA { .. } => p.normal_w += step.dtheta.cross(p.normal_w),
                BasicContact::TypeB { .. } => p.point_w += motion - p.normal_w * p.normal_w.dot(motion),
                BasicContact::TypeC { edge_a, edge_b } => {
                    let Some(q) = pair else { continue };
                    let (a, b) = (solids.part(q.part as usize), solids.piece(q.piece as usize));
                    p.follow_crossing(r * a.edge_direction(edge_a), b.edge_direction(edge_b), motion);
                }
            }
            deepest = deepest.min(p.gap);
        }
        // A penetration that no contact in view accounts for is not got rid of.
        if self.penetration > 0.0 && self.penetration <= PENETRATION - before {
            self.penetration = -deepest;
        }
    }

    /// Adds the contacts that take place at the proxy to a formation of none; how many found no room.
    pub fn state(&mut self, formation: &mut ContactFormation) -> u32 {
        let mut dropped = 0;
        std::mem::swap(&mut self.touching, &mut self.touched);
        self.touching.fill(false);
        let Self { pairs, points, places, pieces, touching, touched, .. } = self;
        let index = |pair: &InReach| pair.part as usize * *pieces + pair.piece as usize;
        let limit = |pair: &InReach| if touched[index(pair)] { LEAVING } else { TOUCHING };
        let here = |pair: &InReach| {
            let limit = limit(pair);
            points[pair.first..pair.end].iter().filter(move |p| p.gap <= limit)
        };
        for pair in &*pairs {
            let Some(deepest) = here(pair).min_by(|p, q| p.gap.total_cmp(&q.gap)) else { continue };
            touching[index(pair)] = true;
            // Pieces that are one solid make one contact there.
            let is_with = |q: &&InReach| std::ptr::eq(*q, pair) || OnePlane::WALL.holds_for(&q.plane, &pair.plane);
            places.clear();
            places.extend(pairs.iter().filter(is_with).flat_map(here).map(|p| p.point_w));
            let kind = FormationKind::of(places, deepest.normal_w, deepest.contact);
            formation.kind = formation.kind.max(kind);
            for p in here(pair) {
                let kept = formation.push(ContactPoint {
                    part_a: pair.part,
                    piece_b: pair.piece,
                    contact: p.contact,
                    point_w: p.point_w,
                    normal_w: p.normal_w,
                    distance: p.gap,
                    kind,
                });
                dropped += u32::from(!kept);
            }
        }
        dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::cuboid;
    use cspace::{FixedPart, World};
    use spatial::DQuat;
    use std::sync::Arc;

    /// A pair that is listed by its region and by its hollow ends made the list grow, on the servo thread.
    #[test]
    fn there_is_room_for_pairs_that_are_listed_twice() {
        // Two walls of a square hole; the part's upright edge goes about the corner of its rim, tilted.
        let wall = |x: [f64; 2], y: [f64; 2]| FixedPart {
            polyhedron: Arc::new(cuboid(DVec3::new(x[0], y[0], -0.02), DVec3::new(x[1], y[1], 0.0))),
            obstacle: 0,
        };
        let world = World {
            moving: vec![Arc::new(cuboid(DVec3::splat(-0.006), DVec3::splat(0.006)))],
            fixed: vec![wall([0.01, 0.03], [-0.03, 0.03]), wall([-0.03, 0.01], [0.01, 0.03])],
        };
        let pairs = world.fixed.len();
        let solids = Solids::new(Arc::new(world));
        let mut view = View::new(&solids);
        let room = view.pairs.capacity();
        let mut most = 0;
        for i in 0..20_000u32 {
            let wave = |k: f64| (f64::from(i) * k).sin();
            let turn = DQuat::from_rotation_y(0.5 * wave(0.011)) * DQuat::from_rotation_x(0.5 * wave(0.0137));
            let on_edge = turn * DVec3::new(0.006, 0.006, 0.005 * wave(0.0071));
            let beside = DVec3::new(wave(0.31), wave(0.37), wave(0.47)) * 2e-4;
            view.look(&solids, &Pose::new(DVec3::new(0.01, 0.01, 0.0) + beside - on_edge, turn), view.reach);
            most = most.max(view.pairs.len());
        }
        assert!(most > pairs, "no pair was listed twice: the test shows nothing");
        assert_eq!(view.pairs.capacity(), room);
    }
}
