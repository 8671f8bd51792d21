use crate::audit::{AuditScratch, Verdict, audit};
use crate::certificate::Certificate;
use crate::placed::{At, Placed};
use crate::walk::Found;
use crate::{BasicContact, Body, CFace, Tracked};
use spatial::{DVec3, Pose};

/// Moves one walk may make in a step; a global seed may cross the whole C-obstacle.
pub(crate) const STEP_MOVES: u32 = 512;
/// Poses put between two samples that lie far apart.
const MAX_SUBSTEPS: u32 = 8;
/// Nearer planes that one step follows up.
const MAX_RIVALS: u32 = 6;

/// Square of an angle turned, divided by that of the change of the quaternion: at most 2.1^2 up to 1.5 radians.
const CHORD2: f64 = 4.5;

/// The walking state of one pair: small and `Copy`, so that pools of pairs cost nothing to make.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairState {
    near: BasicContact,
    /// The globally nearest C-face when it is not the tracked one.
    rival: Option<BasicContact>,
    certificate: Certificate,
    /// The pose that quick steps count from, and A's centre there.
    last: Pose,
    last_center: DVec3,
    /// Square of the way that A's centre may go from there in quick steps, metres squared.
    travel2: f64,
    /// Square of the change of the quaternion up to which Near surely stays applicable.
    chord2: f64,
    /// The same, up to which a quick step does if Near is seen to be applicable.
    known2: f64,
    /// See [`Found::tan_half`].
    tan_half: f64,
    /// The last full step ended where it began, and was sure of it.
    stayed: bool,
    seeded: bool,
}

impl PairState {
    pub(crate) const NEW: Self = Self {
        near: crate::c_face::type_b(0, 0),
        rival: None,
        certificate: Certificate::NONE,
        last: Pose::IDENTITY,
        last_center: DVec3::ZERO,
        travel2: 0.0,
        chord2: 0.0,
        known2: 0.0,
        tan_half: 0.0,
        stayed: false,
        seeded: false,
    };

    pub(crate) fn forget(&mut self) {
        self.seeded = false;
        self.chord2 = 0.0;
        self.known2 = 0.0;
    }

    pub(crate) fn is_seeded(&self) -> bool {
        self.seeded
    }

    pub(crate) fn near(&self) -> BasicContact {
        self.near
    }

    /// Whether Near is, if it stays applicable, surely what it is while A moves by no more than `way`, metres: see [`Placed::is_calm`].
    pub(crate) fn is_calm(&self, placed: &Placed<'_>, way: f64) -> bool {
        self.seeded
            && self.rival.is_none()
            && way < 0.1 * jump(placed)
            && placed.is_calm(self.near, &self.certificate, way)
    }

    /// Whether Near surely stays applicable meanwhile.
    pub(crate) fn stays_applicable(&self, placed: &Placed<'_>, way: f64) -> bool {
        placed.stays_applicable(self.near, way)
    }

    /// What a step says of a pair that is calm; none if Near may not be applicable. `is_known`: it is.
    #[inline]
    pub(crate) fn calm_step(&self, placed: &Placed<'_>, is_known: bool) -> Option<Tracked> {
        placed.plane_if_applicable(self.near, is_known).map(Tracked::quick)
    }

    /// One step: see [`crate::Tracker::step`].
    #[inline]
    pub(crate) fn step(&mut self, a: &Body, b: &Body, scratch: &mut AuditScratch, at: &At<'_>) -> Tracked {
        let placed = Placed::new(a, b, at);
        let travel2 = (at.center - self.last_center).length_squared();
        let chord2 = (at.pose.rotation - self.last.rotation).length_squared();
        // A rival asks for more than a quick step.
        let near_last = travel2 < self.travel2 && self.rival.is_none();
        let sure = near_last && chord2 < self.chord2;
        let steady = sure || near_last && chord2 < self.known2 && self.may_hold(&placed);
        let mut unproven = None;
        if steady && let Some((near, inside)) = placed.stay(self.near, sure, self.tan_half) {
            if near.distance > 0.0 || self.certificate.proves(&placed, &near, inside) {
                return Tracked::quick(near);
            }
            unproven = Some((near, inside));
        }
        if steady
            && self.stayed
            && let Some(tracked) = self.second_look(&placed, sure, unproven)
        {
            return tracked;
        }
        self.full_step(&placed, scratch, steady, travel2 + CHORD2 * a.radius * a.radius * chord2)
    }

    /// Near, where a closer look at its neighbours and at the fold along its side settle what a quick step left open.
    #[inline(never)]
    fn second_look(&self, placed: &Placed<'_>, sure: bool, unproven: Option<(CFace, f64)>) -> Option<Tracked> {
        let mut planes = 1;
        let (near, inside) = match unproven {
            Some(stays) => stays,
            None => {
                let (near, inside) = placed.stay_among(self.near, sure, &mut planes)?;
                if near.distance > 0.0 || self.certificate.proves(placed, &near, inside) {
                    return Some(Tracked { planes, ..Tracked::quick(near) });
                }
                (near, inside)
            }
        };
        self.certificate
            .proves(placed, &near, placed.folded_disc(&near, inside))
            .then_some(Tracked { planes, ..Tracked::quick(near) })
    }

    /// Whether Near is surely applicable; of two edges [`Placed::stay`] tells.
    #[inline]
    fn may_hold(&mut self, placed: &Placed<'_>) -> bool {
        matches!(self.near, BasicContact::TypeC { .. }) || self.still_leads(placed)
    }

    /// Whether Near, a vertex and a face, is surely applicable.
    #[inline(never)]
    fn still_leads(&mut self, placed: &Placed<'_>) -> bool {
        let steady = placed.lead(self.near);
        if steady > 0.0 {
            self.stand(placed, steady, f64::INFINITY);
        }
        steady > 0.0
    }

    /// Quick steps count from here: Near stays applicable while A turns by no more than `steady`, and what is known of
    /// its neighbours holds up to `known`, radians.
    #[inline]
    fn stand(&mut self, placed: &Placed<'_>, steady: f64, known: f64) {
        // They must not add up to a jump.
        let travel = 0.25 * jump(placed);
        let turn = travel / placed.a.radius;
        let chord2 = |angle: f64| angle * angle / CHORD2;
        self.last = *placed.at.pose;
        self.last_center = placed.at.center;
        self.travel2 = travel * travel;
        self.chord2 = chord2(steady.min(turn).max(0.0));
        self.known2 = chord2(known.min(turn).max(0.0));
    }

    /// A step that looks at Near's neighbours, and farther where they do not answer. `steady`: Near is applicable.
    /// `moved2`: the squares of travel and turn since the last such step, added, metres squared.
    fn full_step(&mut self, placed: &Placed<'_>, scratch: &mut AuditScratch, steady: bool, moved2: f64) -> Tracked {
        let (a, b) = (placed.a, placed.b);
        let limit = jump(placed);
        let mut planes = 0;
        let mut reseeded = false;
        let jump = self.seeded && moved2 > limit * limit;
        if jump {
            reseeded = self.follow_jump(a, b, placed.at.pose, limit, &mut planes);
        }
        let mut near = if self.seeded {
            placed.settle(self.near, steady && !jump, STEP_MOVES, &mut planes)
        } else {
            reseeded = true;
            self.seed(placed, scratch, &mut planes)
        };
        if !near.settled {
            reseeded = true;
            near = self.seed(placed, scratch, &mut planes);
        }
        let mut divergent = false;
        self.stayed = near.face.contact == self.near;
        if near.face.distance > 0.0 {
            self.rival = None;
        } else if self.rival.is_some() || !self.proves(placed, &near) {
            self.stayed = false;
            (near, divergent) = self.examine(placed, near, scratch, &mut reseeded, &mut planes);
        }
        self.near = near.face.contact;
        self.tan_half = near.tan_half;
        self.stand(placed, near.steady, near.known);
        let distance = near.face.distance;
        Tracked { near: near.face, depth: (-distance).max(0.0), distance, divergent, reseeded, planes }
    }

    /// Whether the depth of a settled node is known to be the global one.
    fn proves(&self, placed: &Placed<'_>, near: &Found) -> bool {
        self.certificate.proves(placed, &near.face, near.inside)
            || near.settled && self.certificate.proves(placed, &near.face, placed.folded_disc(&near.face, near.inside))
    }

    /// Walks through poses between the last one and this one. True if that would take too many: then Near is lost.
    #[cold]
    fn follow_jump(&mut self, a: &Body, b: &Body, pose: &Pose, limit: f64, planes: &mut u32) -> bool {
        let travel = (pose.transform_point(a.center) - self.last.transform_point(a.center)).length();
        let turn = self.last.rotation_to(pose).length();
        let count = ((travel + a.radius * turn) / limit).ceil();
        if !(count <= f64::from(MAX_SUBSTEPS)) {
            self.seeded = false;
            return true;
        }
        for i in 1..count as u32 {
            let between = self.last.interpolate(pose, f64::from(i) / count);
            let found = Placed::new(a, b, &At::new(a, &between)).settle(self.near, false, STEP_MOVES, planes);
            self.near = found.face.contact;
        }
        false
    }

    /// A fresh Near from nothing: down from the line of centres, then to the globally nearest plane.
    #[cold]
    fn seed(&mut self, placed: &Placed<'_>, scratch: &mut AuditScratch, planes: &mut u32) -> Found {
        let (a, b) = (placed.a, placed.b);
        let m = (placed.at.center - b.center).try_normalize().unwrap_or(DVec3::Z);
        let va = a.lowest_of_all(placed.turn_to_a(m), planes);
        let vb = b.lowest_of_all(-m, planes);
        let moves = STEP_MOVES + (a.planes.len() + b.planes.len()) as u32;
        let mut near = placed.settle(placed.node_from_direction(m, va, vb), false, moves, planes);
        self.rival = None;
        self.certificate = Certificate::NONE;
        for _ in 0..MAX_RIVALS {
            if near.face.distance > 0.0 {
                break;
            }
            match audit(placed, &near, scratch, planes) {
                Verdict::Nearer { direction, a, b } => {
                    let found = placed.settle(placed.node_from_direction(direction, a, b), false, moves, planes);
                    if !(found.face.distance > near.face.distance) {
                        break;
                    }
                    near = found;
                }
                Verdict::Proven { tan_half_cap, slack } => {
                    self.certificate = Certificate::new(placed, &near.face, tan_half_cap, slack);
                    break;
                }
                Verdict::Open => break,
            }
        }
        self.seeded = true;
        near
    }

    /// The part of the step that only deep or doubtful contacts need: is another plane nearer, is `x` free after all? If one is nearer,
    /// it may be beside Near's facet: the walk compares C-faces, and where ties divide a facet none of them speaks for it.
    #[cold]
    fn examine(
        &mut self,
        placed: &Placed<'_>,
        near: Found,
        scratch: &mut AuditScratch,
        reseeded: &mut bool,
        planes: &mut u32,
    ) -> (Found, bool) {
        let mut near = near;
        for _ in 0..MAX_RIVALS {
            let (found, divergent) = self.look_farther(placed, near, scratch, reseeded, planes);
            if !divergent {
                return (found, false);
            }
            match placed.beyond_ties(&found, planes) {
                Some(beside) => near = beside,
                None => return (found, true),
            }
            if near.face.distance > 0.0 {
                self.rival = None;
                return (near, false);
            }
        }
        (near, true)
    }

    /// Near, or a plane that proves `x` free; and whether another plane is nearer than Near, or may be.
    fn look_farther(
        &mut self,
        placed: &Placed<'_>,
        near: Found,
        scratch: &mut AuditScratch,
        reseeded: &mut bool,
        planes: &mut u32,
    ) -> (Found, bool) {
        // The rival is tracked like Near; it stops being one when it is no nearer.
        let mut best = near;
        if let Some(rival) = self.rival {
            let found = placed.settle(rival, false, STEP_MOVES, planes);
            if found.face.distance > near.face.distance + 2.0 * placed.eps() {
                best = found;
            } else {
                self.rival = None;
            }
        }
        let mut proven = false;
        for _ in 0..MAX_RIVALS {
            if best.face.distance > 0.0 {
                // One plane with f > 0 proves freedom: let go.
                *reseeded = true;
                self.rival = None;
                return (best, false);
            }
            if self.proves(placed, &best) {
                proven = true;
                break;
            }
            match audit(placed, &best, scratch, planes) {
                Verdict::Proven { tan_half_cap, slack } => {
                    self.certificate = Certificate::new(placed, &best.face, tan_half_cap, slack);
                    proven = true;
                    break;
                }
                Verdict::Nearer { direction, a, b } => {
                    let found = placed.settle(placed.node_from_direction(direction, a, b), false, STEP_MOVES, planes);
                    if !(found.face.distance > best.face.distance) {
                        break;
                    }
                    best = found;
                }
                Verdict::Open => break,
            }
        }
        self.rival = (best.face.distance > near.face.distance + 2.0 * placed.eps()).then_some(best.face.contact);
        (near, self.rival.is_some() || !proven)
    }
}

/// The way between two poses that is followed with poses put between, metres.
#[inline]
fn jump(placed: &Placed<'_>) -> f64 {
    0.5 * (placed.a.inner_radius + placed.b.inner_radius)
}
