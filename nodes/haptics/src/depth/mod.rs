//! The laws that read the wrench off the hand's own pose: `paper`, `pstar` and `blended`.

mod compromise;
mod one_region;
mod paper_torque;
mod reduced_hull;
mod scp;
mod shares;

pub(crate) use scp::SCP_MARGIN;

use crate::region::{Clipper, Gone, Known, RegionPoint, Scope, Way, push_within, tied_contacts};
use crate::solid::{Pair, Placed, Sensed, Solids};
use crate::{ContactPoint, FormationKind, Gains, LawKind, LawOutput};
use cspace::{BasicContact, contact_point_turned};
use one_region::{deepest_of_equals, is_above_its_equals, is_equal, one_region};
use paper_torque::torque;
use reduced_hull::nearest_point;
use scp::{Scp, Touch};
use shares::Shares;
use spatial::{DVec3, Pose};

/// Scratch of the depth laws, and whether contact was multiple at the last tick.
#[derive(Debug)]
pub(crate) struct DepthLaw {
    scp: Scp,
    points: Vec<RegionPoint>,
    places: Vec<DVec3>,
    weights: Vec<f64>,
    sharpness: Vec<f64>,
    shares: Shares,
    order: Vec<u16>,
    hull: Vec<DVec3>,
    clipper: Clipper,
    /// Of each pair.
    known: Vec<Known>,
    pieces: usize,
    way: Way,
    multiple: bool,
}

/// Blunter contacts are none to tell of.
const BLUNT: f32 = 0.005;
/// Most contact points held at once.
const ROOM: usize = 256;

impl DepthLaw {
    pub fn new(solids: &Solids) -> Self {
        Self {
            scp: Scp::new(solids),
            points: Vec::with_capacity(ROOM),
            places: Vec::with_capacity(ROOM),
            weights: Vec::with_capacity(ROOM),
            sharpness: Vec::with_capacity(ROOM),
            shares: Shares::new(ROOM),
            order: vec![0; ROOM],
            hull: Vec::with_capacity(ROOM),
            clipper: Clipper::for_world(&solids.world),
            known: vec![Known::NOTHING; solids.world.moving.len() * solids.world.fixed.len()],
            pieces: solids.world.fixed.len(),
            way: Way::new(solids.lever()),
            multiple: false,
        }
    }

    pub fn reset(&mut self) {
        self.multiple = false;
        self.known.fill(Known::NOTHING);
        self.scp.reset();
    }

    /// The wrench at the hand's pose from the pairs sensed there, written into the `result` of a hand that is free.
    pub fn render(
        &mut self,
        solids: &Solids,
        pairs: &[Sensed],
        hip: &Pose,
        law: LawKind,
        gains: &Gains,
        result: &mut LawOutput,
    ) {
        let placed = Placed::new(hip);
        let x0 = hip.translation;
        self.points.clear();
        result.depth = self.scp.find(solids, pairs, hip, &placed);
        if !(result.depth > 0.0) {
            self.multiple = false;
            return;
        }
        let shift = self.scp.shift();
        result.proxy.translation = x0 + shift; // one plane alone: (1)
        result.wrench.force = shift * gains.stiffness; // (2)
        result.energy = 0.5 * gains.stiffness * shift.length_squared();
        // The contacts take place at the SCP: along one plane's normal that changes nothing, across it their arms do.
        let aside = if self.scp.touches.iter().filter(|t| t.push > 0.0).count() > 1 { shift } else { DVec3::ZERO };
        let there = placed.shifted(aside);
        for t in &mut self.scp.touches {
            t.left = t.plane.distance + t.plane.normal_w.dot(aside);
        }
        let gone = self.way.go(there.x, hip.rotation);
        self.contacts(solids, pairs, (&there, gone), law, gains, result);
        for i in 0..self.scp.touches.len() {
            let t = self.scp.touches[i];
            if t.push > 0.0 {
                result.wrench.torque += self.torque_of(i, t, there.x, law, gains);
            }
        }
    }

    /// The penetration of the hand's pose, metres, `>= 0`.
    pub fn depth(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose) -> f64 {
        self.scp.depth(solids, pairs, hip, &Placed::new(hip))
    }

    /// Clips the contact regions of the penetrating pairs and states the formation.
    fn contacts(
        &mut self,
        solids: &Solids,
        pairs: &[Sensed],
        (placed, gone): (&Placed, Gone),
        law: LawKind,
        gains: &Gains,
        result: &mut LawOutput,
    ) {
        // One state for all pairs: the pieces of one obstacle must switch together.
        let was_multiple = std::mem::take(&mut self.multiple);
        for i in 0..self.scp.touches.len() {
            let t = &mut self.scp.touches[i];
            if t.plane.distance >= 0.0 {
                continue;
            }
            t.tie *= if was_multiple { 1.5 } else { 1.0 };
            // Its nearest contact may be the end of a cut, which only looks like a corner.
            let is_seamless = solids.is_seamless(t.part as usize, t.piece as usize);
            let may_be_cut = !is_seamless && is_above_its_equals(&self.scp.touches, i);
            let t = &mut self.scp.touches[i];
            let pair = Pair::new(solids, t.part, t.piece, placed);
            let within = within(t, law, gains);
            let (limit, plane) = (t.left + within, t.plane_there());
            t.first = self.points.len();
            // Along Near's normal no contact can be deeper than Near.
            let scope = Scope { reach: limit, near_felt: !may_be_cut, wide: law == LawKind::Blended, along_near: true };
            let known = &mut self.known[pair.part * self.pieces + pair.piece];
            let is_clipped = may_be_cut
                || !tied_contacts(&pair, &plane, within, &scope, (known, gone, self.way.lever), &mut self.points);
            if is_clipped {
                self.clipper.region(&pair, &plane, &scope, &mut self.points);
            }
            t.end = self.points.len();
            if law == LawKind::Blended && t.push > 0.0 && pairs.len() > 1 {
                // Behind all others what of the region belongs to other pairs: pieces that go on flush with this one. The depths
                // there may be small, or gaps, where the pair has no contact of its own.
                let scope = Scope { near_felt: false, ..scope };
                if !is_clipped {
                    for p in &mut self.points[t.first..t.end] {
                        p.sharpness = solids.sharpness(pair.part, pair.piece, p.contact);
                    }
                    self.clipper.start(&pair, &plane, &scope);
                }
                self.clipper.beside(&pair, pairs, &plane, &scope, &mut self.points);
            }
            t.beside = [t.end, self.points.len()];
        }
        self.stand_in(solids, placed);
        let Self { scp, points, places, .. } = self;
        for i in 0..scp.touches.len() {
            // Pieces that are one solid make one contact of one kind, and the deepest tells what takes place.
            let (deepest, pieces) = deepest_of_equals(&scp.touches, i);
            let level = deepest + within(&scp.touches[i], law, gains);
            scp.touches[i].level = level;
            let t = &scp.touches[i];
            if t.first == t.end {
                continue;
            }
            // Between facets that are one face nothing takes place.
            let here = |u: &Touch| {
                let own = u.plane.contact;
                let counts = move |p: &&RegionPoint| p.gap <= level && (p.sharpness >= BLUNT || p.contact == own);
                points[u.first..u.end].iter().filter(counts)
            };
            places.clear();
            if pieces == 1 {
                places.extend(here(t).map(|p| p.point_w));
            } else {
                places.extend(scp.touches.iter().filter(|u| is_equal(t, u)).flat_map(here).map(|p| p.point_w));
            }
            if places.is_empty() {
                continue;
            }
            let kind = FormationKind::of(places, t.plane.normal_w, t.plane.contact);
            self.multiple |= kind >= FormationKind::EdgeFace;
            result.formation.kind = result.formation.kind.max(kind);
            for p in here(t) {
                let kept = result.formation.push(ContactPoint {
                    part_a: t.part,
                    piece_b: t.piece,
                    contact: p.contact,
                    point_w: p.point_w,
                    normal_w: p.normal_w,
                    distance: p.gap + t.plane.distance - t.left,
                    kind,
                });
                // Those that only fade in do not take place.
                result.dropped += u32::from(!kept && p.gap <= t.left + t.tie);
            }
        }
    }

    /// Gives a plane that pushes, but has no contact where the hand is, its own: it takes place at the SCP, and the hand may be
    /// beyond the end of the piece.
    fn stand_in(&mut self, solids: &Solids, placed: &Placed) {
        let touches = &mut self.scp.touches;
        for i in 0..touches.len() {
            let t = touches[i];
            let has_own = t.first < t.end;
            if t.push > 0.0 && !has_own && !touches.iter().any(|u| u.first < u.end && is_equal(&t, u)) {
                let (a, b) = (solids.part(t.part as usize), solids.piece(t.piece as usize));
                let at = contact_point_turned(t.plane.contact, a, b, placed.x, &placed.r);
                let on_b = match t.plane.contact {
                    BasicContact::TypeB { .. } => at - t.plane.normal_w * t.left,
                    _ => at,
                };
                touches[i].first = self.points.len();
                push_within(&mut self.points, RegionPoint::of(&t.plane_there(), on_b));
                touches[i].end = self.points.len();
            }
        }
    }

    /// The torque of the force share that plane `i` carries, over the contacts of all pairs with an equal plane.
    fn torque_of(&mut self, i: usize, t: Touch, x0: DVec3, law: LawKind, gains: &Gains) -> DVec3 {
        let normal = t.plane.normal_w;
        let force = normal * (t.push * gains.stiffness);
        self.places.clear();
        self.weights.clear();
        self.sharpness.clear();
        let fade = within(&t, law, gains);
        let Self { scp, points, places, weights, sharpness, .. } = self;
        let mut add = |p: &RegionPoint| {
            if places.len() < ROOM {
                // (5), (6) and the nearest point know the contact plane only: slide App along n to the level of x0.
                places.push(p.point_w + normal * normal.dot(x0 - p.point_w));
                if law != LawKind::Paper {
                    let short = p.gap - t.left;
                    let weight = if law == LawKind::Blended { (1.0 - short / fade).clamp(0.0, 1.0) } else { 1.0 };
                    weights.push(weight);
                    sharpness.push(f64::from(p.sharpness));
                }
            }
        };
        let one_region = one_region(&t);
        let is_equal = |u: &Touch| one_region.holds_for(&t.plane, &u.plane);
        for (j, u) in scp.touches.iter().enumerate().filter(|(j, u)| *j == i || is_equal(u)) {
            points[u.first..u.end].iter().filter(|p| p.gap <= t.level).for_each(&mut add);
            if i == j {
                points[u.beside[0]..u.beside[1]].iter().for_each(&mut add);
            }
        }
        if law == LawKind::Paper {
            return torque(&self.places, normal, force, x0, &mut self.hull).0;
        }
        if self.weights.iter().sum::<f64>() < 1.0 {
            // Only rounding lets the deepest contact weigh less than one.
            if let Some(w) = self.weights.iter_mut().max_by(|a, b| a.total_cmp(b)) {
                *w = 1.0;
            }
        }
        if law == LawKind::Blended {
            self.shares.spread(&self.places, normal, &mut self.weights, &self.sharpness, &mut self.order);
        }
        let p = nearest_point(&self.places, &self.weights, &mut self.order, x0);
        force.cross(x0 - p)
    }
}

/// How far above the deepest contact others take part, metres.
#[inline]
fn within(t: &Touch, law: LawKind, gains: &Gains) -> f64 {
    if law == LawKind::Blended { gains.blend_depth.max(t.tie) } else { t.tie }
}
