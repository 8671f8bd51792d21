//! From tick to tick the same planes hold the SCP nearly always: then there is nothing to search.

use super::{FAR, Scp, Touch, row, tie_of};
use crate::pair::Covered;
use crate::placed::Placed;
use crate::renderer::SCP_MARGIN;
use crate::sense::Sensed;
use crate::solid::Solids;
use spatial::Pose;

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
}

impl Held {
    fn new(pairs: &[Sensed], hip: &Pose, depth: f64) -> Self {
        Self { at: *hip, room2: (ROOM * depth).powi(2), inside: inside(pairs) }
    }

    fn reaches(&self, hip: &Pose, lever: f64) -> bool {
        let turn2 = 4.0 * (hip.rotation - self.at.rotation).length_squared();
        2.0 * ((hip.translation - self.at.translation).length_squared() + lever * lever * turn2) <= self.room2
    }
}

impl Scp {
    /// Lets the planes found be held while the hand stays within [`ROOM`], unless another one may be taken meanwhile.
    pub(super) fn begin_to_hold(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed, depth: f64) {
        let room = ROOM * depth;
        let together = self.touches.iter().filter(|t| t.push > 0.0).count() > 1;
        let farthest = -self.shift.length() - 2.0 * room;
        let is_rivalled = |t: &Touch| {
            let pair = solids.pair(t.part, t.piece, placed);
            let Some(s) = pairs.iter().find(|s| (s.part, s.piece) == (t.part, t.piece)) else { return true };
            // A face of the pair may become nearer than its plane: either may change by the way that is moved.
            let by_face =
                s.near.contact != t.plane.contact && pair.is_rivalled(&s.near, &t.plane, t.plane.distance - 2.0 * room);
            // Or let the SCP come nearer.
            let mut by_choice = false;
            if together && t.push > 0.0 && !by_face {
                pair.offer_planes_beside(&t.plane, farthest, |face| {
                    by_choice = by_choice || pair.is_felt(&face, Covered::Unfelt);
                });
            }
            by_face || by_choice
        };
        self.held = (!self.touches.iter().any(is_rivalled)).then(|| Held::new(pairs, hip, depth));
    }

    /// Lets the planes between which the part is wedged be held while the hand stays within [`ROOM`].
    pub(super) fn hold_wedged(&mut self, pairs: &[Sensed], hip: &Pose, depth: f64) {
        self.held = Some(Held::new(pairs, hip, depth));
    }

    /// The depth and, in `touches`, the planes that hold the SCP if those of the last tick still do: each takes place where the
    /// projection on them leads, no other pair is reached there, and no pair has a felt plane that is nearer.
    ///
    /// Near the SCP these planes bound what is free, so that the projection on them is the nearest touching configuration
    /// around. That no edge contact elsewhere has become nearer is taken for granted within [`ROOM`].
    pub(super) fn hold(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed) -> Option<f64> {
        let held = self.held.take().filter(|h| h.reaches(hip, self.lever))?;
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
        self.projection.solve_again(&self.rows);
        if self.projection.contradictions > 0 {
            return None;
        }
        self.take_projection();
        let (depth, shift) = (self.depth_of_touches(), self.shift);
        if !(depth > 0.0) || shift.length_squared() > SCP_MARGIN.min(FAR * depth).powi(2) {
            return None;
        }
        let is_apart = |s: &Sensed| {
            let left = s.near.distance + s.near.normal_w.dot(shift);
            left > 4.0 * tie_of(solids, s.part) || self.touches.iter().any(|t| (t.part, t.piece) == (s.part, s.piece))
        };
        if !pairs.iter().all(is_apart) || !self.takes_place(solids, &placed.shifted(shift)) {
            return None;
        }
        self.held = Some(held);
        Some(depth)
    }

    /// The same planes at this pose; none if one of them is no longer the felt one.
    fn take_along(&mut self, solids: &Solids, pairs: &[Sensed], placed: &Placed) -> Option<()> {
        self.rows.clear();
        for t in &mut self.touches {
            let s = pairs.iter().find(|s| (s.part, s.piece) == (t.part, t.piece))?;
            let pair = solids.of(s, placed);
            // A nearest plane that is felt is the one to hold.
            let is_near = s.near.contact == t.plane.contact;
            let covered = if is_near { Covered::Felt } else { Covered::Unfelt };
            if pair.is_felt(&s.near, covered) != is_near {
                return None;
            }
            t.plane = if is_near { s.near } else { pair.applicable_plane(t.plane.contact)? };
            (t.first, t.end, t.tie) = (0, 0, tie_of(solids, t.part));
            self.rows.push(row(&t.plane));
        }
        Some(())
    }
}

/// How many pairs penetrate.
fn inside(pairs: &[Sensed]) -> usize {
    pairs.iter().filter(|s| s.near.distance < 0.0).count()
}
