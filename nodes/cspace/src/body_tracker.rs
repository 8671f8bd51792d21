use crate::audit::AuditScratch;
use crate::bvh::{Aabb, Bvh};
use crate::pair_state::PairState;
use crate::placed::{At, Placed};
use crate::{Body, Tracked, World};
use spatial::{DVec3, Pose};
use std::sync::Arc;

/// Most obstacle pieces that one moving part keeps in view at a time.
pub const MAX_NEAR_PIECES: usize = 4096;

/// Ticks at the present speed for which a pair may be calm; for fewer, if it is not for more.
const CALM_TICKS: [f64; 2] = [16.0, 4.0];
/// Such times after which it is asked again at the latest.
const MOST_ASK_AFTER: f64 = 8.0;
/// The speed that counts at least and at most, in radii of the part a tick.
const PACE: [f64; 2] = [1e-6, 1e-3];

/// A pair nearer than the margin, and what its tracker says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActivePair {
    /// Index into [`World::moving`].
    pub part: u32,
    /// Index into [`World::fixed`].
    pub piece: u32,
    /// The pair's state in this tick.
    pub tracked: Tracked,
}

/// A piece in view of a part.
#[derive(Clone, Copy, Debug)]
struct Seen {
    piece: u32,
    state: PairState,
    /// The part's odometer up to which the pair is known to stay apart.
    apart_until: f64,
    /// The same, up to which it is known to be calm, or from which on that is worth asking.
    calm_until: f64,
    ask_calm: f64,
    /// Near is known to stay applicable while the pair is calm.
    stays_applicable: bool,
    /// After how many times that long, next.
    ask_after: f64,
}

/// One convex part of A and the pieces in its view.
#[derive(Debug)]
struct Part {
    body: Body,
    seen: Vec<Seen>,
    old: Vec<Seen>,
    /// Length of the way that no point of the part can have exceeded, metres.
    odometer: f64,
    /// Odometer at which the view is out of date.
    view_until: f64,
    /// The last pose, and the part's centre there.
    last: Option<(Pose, DVec3)>,
}

/// Tracks a manipulated body of several convex parts against many obstacle pieces.
///
/// A tree over the pieces gives each part its view, with room for some motion, so that it is asked only now and then.
/// A pair in view but clearly apart rests until the body has moved by its clearance. Pairs come and go inside
/// preallocated room: nothing is allocated in a step.
#[derive(Debug)]
pub struct BodyTracker {
    world: Arc<World>,
    parts: Vec<Part>,
    pieces: Vec<Body>,
    tree: Bvh,
    margin: f64,
    scratch: AuditScratch,
    active: Vec<ActivePair>,
    overflow: u32,
}

impl BodyTracker {
    /// A tracker of the whole world; pairs whose distance is up to `margin` metres (`>= 0`) are reported.
    #[must_use]
    pub fn new(world: Arc<World>, margin: f64) -> Self {
        let room = world.fixed.len().min(MAX_NEAR_PIECES);
        let parts = world
            .moving
            .iter()
            .map(|p| Part {
                body: Body::new(p, true),
                seen: Vec::with_capacity(room),
                old: Vec::with_capacity(room),
                odometer: 0.0,
                view_until: f64::NEG_INFINITY,
                last: None,
            })
            .collect::<Vec<_>>();
        let boxes =
            world.fixed.iter().map(|f| Aabb::of(f.polyhedron.corner_ids().map(|v| f.polyhedron.vertex(v)))).collect();
        Self {
            pieces: world.fixed.iter().map(|f| Body::new(&f.polyhedron, false)).collect(),
            tree: Bvh::new(boxes),
            active: Vec::with_capacity(room * parts.len()),
            margin: if margin > 0.0 { margin } else { 0.0 },
            scratch: AuditScratch::new(),
            overflow: 0,
            parts,
            world,
        }
    }

    /// What is tracked.
    #[must_use]
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// The two bodies of a pair.
    pub(crate) fn bodies(&self, pair: &ActivePair) -> (&Body, &Body) {
        (&self.parts[pair.part as usize].body, &self.pieces[pair.piece as usize])
    }

    /// Forgets the past: every pair is seeded anew when it next comes near.
    pub fn reset(&mut self) {
        for part in &mut self.parts {
            part.seen.clear();
            part.view_until = f64::NEG_INFINITY;
            part.last = None;
        }
    }

    /// Pieces that found no room in a part's view at the last look; their contacts are missed.
    #[must_use]
    pub fn overflow(&self) -> u32 {
        self.overflow
    }

    /// The pairs of the last step.
    #[must_use]
    pub fn active(&self) -> &[ActivePair] {
        &self.active
    }

    /// Follows A to `pose` (A in W): the pairs within the margin, ordered by part and piece. A pair that comes into
    /// view while it is free does not count as reseeded. A pose that is not finite leaves everything as it was.
    pub fn step(&mut self, pose: &Pose) -> &[ActivePair] {
        self.step_within(pose, self.margin)
    }

    /// The same for the pairs within `margin` metres, which may be less than the tracker's and differ from step to step.
    pub fn step_within(&mut self, pose: &Pose, margin: f64) -> &[ActivePair] {
        if !(pose.translation.is_finite() && pose.rotation.is_finite()) {
            return &self.active;
        }
        self.active.clear();
        let Self { parts, pieces, tree, margin: most, scratch, active, overflow, .. } = self;
        let margin = margin.min(*most);
        *overflow = 0;
        for (index, part) in parts.iter_mut().enumerate() {
            let at = At::new(&part.body, pose);
            let moved = part.look(tree, &at, *most, overflow);
            for seen in &mut part.seen {
                if part.odometer < seen.apart_until - margin {
                    continue;
                }
                let piece = &pieces[seen.piece as usize];
                let placed = Placed::new(&part.body, piece, &at);
                let calm = if part.odometer < seen.calm_until {
                    seen.state.calm_step(&placed, seen.stays_applicable)
                } else {
                    None
                };
                let tracked = match calm {
                    Some(tracked) => tracked,
                    None => {
                        let fresh = !seen.state.is_seeded();
                        let mut tracked = seen.state.step(&part.body, piece, scratch, &at);
                        tracked.reseeded &= !(fresh && tracked.is_free());
                        seen.look_for_calm(&placed, part.odometer, moved);
                        tracked
                    }
                };
                seen.apart_until = part.odometer + tracked.distance;
                if tracked.distance <= margin {
                    active.push(ActivePair { part: index as u32, piece: seen.piece, tracked });
                }
            }
        }
        &self.active
    }
}

impl Part {
    /// Counts the way, and looks around when the view is out of date. Returns the way since the last pose, metres.
    fn look(&mut self, tree: &Bvh, at: &At<'_>, margin: f64, overflow: &mut u32) -> f64 {
        let moved = self.last.map_or(f64::INFINITY, |(pose, center)| {
            let turn = 2.1 * self.body.radius * (at.pose.rotation - pose.rotation).length();
            (at.center - center).length() + turn
        });
        self.last = Some((*at.pose, at.center));
        if moved.is_finite() {
            self.odometer += moved;
        }
        if moved.is_finite() && self.odometer < self.view_until {
            return moved;
        }
        // Room for a hundred ticks at this speed, within reason.
        let r = self.body.radius;
        let room = if moved.is_finite() { (100.0 * moved).clamp(0.05 * r, 0.5 * r) } else { 0.1 * r };
        self.view_until = self.odometer + room;
        std::mem::swap(&mut self.seen, &mut self.old);
        self.seen.clear();
        tree_into(tree, at.center, r + margin + room, &mut self.seen, overflow);
        self.seen.sort_unstable_by_key(|s| s.piece);
        // Pairs that were in view keep their state; both lists are sorted.
        let mut old = self.old.iter().peekable();
        for seen in &mut self.seen {
            while old.next_if(|o| o.piece < seen.piece).is_some() {}
            if let Some(o) = old.next_if(|o| o.piece == seen.piece) {
                *seen = *o;
            }
        }
        moved
    }
}

impl Seen {
    fn new(piece: u32) -> Self {
        let never = f64::NEG_INFINITY;
        Self {
            piece,
            state: PairState::NEW,
            apart_until: never,
            calm_until: never,
            ask_calm: never,
            stays_applicable: false,
            ask_after: 1.0,
        }
    }

    /// Asks whether the pair is calm for some ticks at this speed; the longer it has not been, the more rarely.
    fn look_for_calm(&mut self, placed: &Placed<'_>, odometer: f64, moved: f64) {
        // What was known was said of Near as it was: it may have ceased to be applicable, and be another one now.
        self.calm_until = f64::NEG_INFINITY;
        if odometer < self.ask_calm {
            return;
        }
        let [least, most] = PACE.map(|pace| pace * placed.a.radius);
        let pace = moved.clamp(least, most);
        for way in CALM_TICKS.map(|ticks| ticks * pace) {
            if self.state.is_calm(placed, way) {
                (self.calm_until, self.ask_after) = (odometer + way, 1.0);
                self.stays_applicable = self.state.stays_applicable(placed, way);
                return;
            }
        }
        (self.ask_calm, self.ask_after) =
            (odometer + self.ask_after * CALM_TICKS[1] * pace, (2.0 * self.ask_after).min(MOST_ASK_AFTER));
    }
}

fn tree_into(tree: &Bvh, center: DVec3, radius: f64, seen: &mut Vec<Seen>, overflow: &mut u32) {
    tree.query(center, radius, |piece| {
        if seen.len() < seen.capacity() {
            seen.push(Seen::new(piece));
        } else {
            *overflow += 1;
        }
    });
}
