//! From tick to tick the same planes hold the SCP nearly always: then there is nothing to search.

use super::{FAR, FREED, SCP_MARGIN, Scp, Touch, is_parted, row, tie_of};
use crate::projection::Projection;
use crate::solid::{Covered, Pair, Placed, SAME, Sensed, Solids};
use cspace::CFace;
use spatial::{DVec3, Pose};

/// Part of the depth that the hand may move before the planes are searched anew.
const ROOM: f64 = 0.05;

/// Where the planes that hold the SCP were searched, and how far from there they may be taken as known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    at: Pose,
    /// Square of the way that a point of the part may have moved, metres squared.
    room2: f64,
    /// Pairs that penetrated there.
    inside: usize,
    wanted: Wanted,
}

/// What the planes are held for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    Scp,
    /// The depth alone; of the planes the first `felt` are the pairs' nearest, the others lie behind seams.
    Depth {
        felt: usize,
    },
}

impl Held {
    /// `room` in metres.
    fn new(pairs: &[Sensed], hip: &Pose, room: f64, wanted: Wanted) -> Self {
        Self { at: *hip, room2: room * room, inside: inside(pairs), wanted }
    }

    fn reaches(&self, hip: &Pose, lever: f64) -> bool {
        let turn2 = 4.0 * (hip.rotation - self.at.rotation).length_squared();
        2.0 * ((hip.translation - self.at.translation).length_squared() + lever * lever * turn2) <= self.room2
    }
}

impl Scp {
    /// Lets the planes found be held while the hand stays within [`ROOM`], or nearer where another one may be taken farther off.
    pub(super) fn begin_to_hold(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed, depth: f64) {
        let room = self.room(solids, pairs, placed, depth);
        let together = self.touches.iter().filter(|t| t.push > 0.0).count() > 1;
        let farthest = -self.shift.length() - 2.0 * room;
        // Another plane may let the SCP come nearer.
        let has_choice = |t: &Touch| {
            let mut found = false;
            if together && t.push > 0.0 {
                let pair = Pair::new(solids, t.part, t.piece, placed);
                pair.offer_planes_beside(&t.plane, farthest, SAME, |face| {
                    found = found || pair.is_felt(&face, Covered::Unfelt);
                });
            }
            found
        };
        let holds = room > 0.0 && !self.touches.iter().any(has_choice);
        self.held = holds.then(|| Held::new(pairs, hip, room, Wanted::Scp));
    }

    /// The same for the planes that tell the depth.
    pub(super) fn begin_to_hold_depth(
        &mut self,
        solids: &Solids,
        pairs: &[Sensed],
        hip: &Pose,
        placed: &Placed,
        depth: f64,
    ) {
        let room = self.room(solids, pairs, placed, depth);
        let is_nearest = |t: &&Touch| pairs.iter().any(|s| is_of(t, s) && s.near.contact == t.plane.contact);
        let wanted = Wanted::Depth { felt: self.touches.iter().take_while(is_nearest).count() };
        self.held = (room > 0.0).then(|| Held::new(pairs, hip, room, wanted));
    }

    /// How far the hand may move before the face of a plane behind a seam may no longer be its pair's nearest, metres, at most
    /// [`ROOM`]: it and another may come nearer by that way each.
    fn room(&self, solids: &Solids, pairs: &[Sensed], placed: &Placed, depth: f64) -> f64 {
        let most = ROOM * depth;
        let of_touch = |t: &Touch| match pairs.iter().find(|s| is_of(t, s)) {
            Some(s) if s.near.contact == t.plane.contact => most,
            Some(s) => 0.5 * Pair::of(solids, s, placed).lead_over_faces(&s.near, &t.plane, 2.0 * most),
            None => 0.0,
        };
        self.touches.iter().map(of_touch).fold(most, f64::min)
    }

    /// Lets the planes between which the part is wedged be held while the hand stays within [`ROOM`].
    pub(super) fn hold_wedged(&mut self, pairs: &[Sensed], hip: &Pose, depth: f64) {
        self.held = Some(Held::new(pairs, hip, ROOM * depth, Wanted::Scp));
    }

    /// The depth and, in `touches`, the planes that hold the SCP if those of the last tick still do: each takes place where the
    /// projection on them leads, no other pair is reached there, and no pair has a felt plane that is nearer.
    ///
    /// Near the SCP these planes bound what is free, so that the projection on them is the nearest touching configuration
    /// around. That no edge contact elsewhere has become nearer is taken for granted within [`ROOM`].
    pub(super) fn hold(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed) -> Option<f64> {
        let held = self.held.take().filter(|h| h.wanted == Wanted::Scp && h.reaches(hip, self.way.lever))?;
        if self.wedged {
            self.take_nearest();
        }
        self.take_along(solids, pairs, placed)?;
        if self.wedged {
            let depth = self.depth_of_touches();
            if !(depth > 0.0) || inside(pairs) != held.inside {
                return None;
            }
            self.give_way(FAR * depth);
            self.held = Some(held);
            return Some(depth);
        }
        self.projection.hold_again(&self.rows);
        if self.projection.contradictions > 0 {
            return None;
        }
        self.take_projection();
        let (depth, shift) = (self.depth_of_touches(), self.shift);
        if !(depth > 0.0) || shift.length_squared() > SCP_MARGIN.min(FAR * depth).powi(2) {
            return None;
        }
        let there = placed.shifted(shift);
        let mut is_apart = |s: &Sensed| {
            let left = s.near.distance + s.near.normal_w.dot(shift);
            left > 4.0 * tie_of(solids)
                || self.touches.iter().any(|t| is_of(t, s))
                || left < -FREED
                    && !self.is_felt(solids, s, placed, Covered::Unfelt)
                    && is_parted(&Pair::of(solids, s, &there), &self.touches, &self.projection)
        };
        if !pairs.iter().all(&mut is_apart) || !self.takes_place(solids, hip, &there) {
            return None;
        }
        if !self.is_felt_there(solids, hip, &there) {
            return None;
        }
        self.held = Some(held);
        Some(depth)
    }

    /// Whether the planes that are felt where the SCP is, and not where the hand is, are so still, and their own pieces touch there:
    /// where the part has passed on to the next piece of a wall, that one's contacts are wanted. They do not tell the depth, which is
    /// that where the hand is.
    fn is_felt_there(&mut self, solids: &Solids, hip: &Pose, there: &Placed) -> bool {
        let Self { touches, lasting, pieces, scp_way, .. } = self;
        let known = (scp_way.go(there.x, hip.rotation), scp_way.lever);
        touches.iter().filter(|t| t.felt_there).all(|t| {
            let pair = Pair::new(solids, t.part, t.piece, there);
            let plane = CFace { distance: 0.0, ..t.plane };
            let lasting = &mut lasting[pair.part * *pieces + pair.piece];
            let is_deepest = touches.iter().all(|u| u.felt_there || u.plane.distance > t.plane.distance);
            !is_deepest
                && lasting.faces(plane.contact, FREED, known, || (pair, plane))
                && pair.is_felt(&plane, Covered::Felt)
        })
    }

    /// The depth if the planes that told it at the last tick still do: each pair with a plane that is felt has that plane, or the one
    /// behind its seam, and all others are free where these lead.
    pub(super) fn hold_depth(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed) -> Option<f64> {
        let held = self.held.take().filter(|h| h.reaches(hip, self.way.lever))?;
        let Wanted::Depth { felt } = held.wanted else { return None };
        self.rows.clear();
        let Self { touches, lasting, pieces, gone, way, .. } = self;
        for (i, t) in touches.iter_mut().enumerate() {
            let s = pairs.iter().find(|s| is_of(t, s))?;
            let pair = Pair::of(solids, s, placed);
            let lasting = &mut lasting[pair.part * *pieces + pair.piece];
            if lasting.is_felt(&s.near, Covered::Unfelt, (*gone, way.lever), || pair) {
                t.plane = s.near;
            } else if i < felt {
                return None;
            } else {
                // The planes before it must still not free the pair by its seam.
                self.projection.solve_again(&self.rows);
                if is_freed(&s.near, &self.projection) {
                    return None;
                }
                t.plane = pair.applicable_plane(t.plane.contact)?;
            }
            self.rows.push(row(&t.plane));
        }
        let is_other = |s: &&Sensed| s.near.distance < 0.0 && !self.touches.iter().any(|t| is_of(t, s));
        let mut others = pairs.iter().filter(is_other).peekable();
        if others.peek().is_some() {
            let contradicted = self.projection.contradictions > 0;
            self.projection.solve_again(&self.rows);
            if contradicted || self.projection.contradictions > 0 {
                return None;
            }
            let there = placed.shifted(DVec3::from_array(self.projection.z));
            let is_free = |s: &Sensed| {
                is_freed(&s.near, &self.projection)
                    || is_parted(&Pair::of(solids, s, &there), &self.touches, &self.projection)
            };
            if !others.all(is_free) {
                return None;
            }
        }
        self.held = Some(held);
        Some(self.depth_of_touches())
    }

    /// The same planes at this pose; none if one of them is no longer the felt one.
    fn take_along(&mut self, solids: &Solids, pairs: &[Sensed], placed: &Placed) -> Option<()> {
        self.rows.clear();
        let Self { touches, lasting, pieces, gone, way, .. } = self;
        for t in touches {
            let s = pairs.iter().find(|s| is_of(t, s))?;
            // A nearest plane that is felt is the one to hold.
            let is_near = s.near.contact == t.plane.contact;
            let covered = if is_near { Covered::Felt } else { Covered::Unfelt };
            let lasting = &mut lasting[s.part as usize * *pieces + s.piece as usize];
            let pair = || Pair::of(solids, s, placed);
            let is_felt = lasting.is_felt(&s.near, covered, (*gone, way.lever), pair);
            // A plane that was found at the SCP may be felt there alone.
            t.felt_there = is_near && !is_felt;
            if is_felt != is_near && !(t.felt_there && t.found_there) {
                return None;
            }
            if is_near {
                t.plane = s.near;
            } else {
                t.plane = pair().applicable_plane(t.plane.contact)?;
            }
            (t.first, t.end, t.beside, t.tie) = (0, 0, [0; 2], tie_of(solids));
            self.rows.push(row(&t.plane));
        }
        Some(())
    }
}

/// Whether a pair is free where the projection leads, by its nearest plane.
fn is_freed(near: &CFace, projection: &Projection<3>) -> bool {
    near.distance + near.normal_w.dot(DVec3::from_array(projection.z)) >= -FREED
}

/// Whether the plane is the pair's.
fn is_of(t: &Touch, s: &Sensed) -> bool {
    (s.part, s.piece) == (t.part, t.piece)
}

/// How many pairs penetrate.
fn inside(pairs: &[Sensed]) -> usize {
    pairs.iter().filter(|s| s.near.distance < 0.0).count()
}
