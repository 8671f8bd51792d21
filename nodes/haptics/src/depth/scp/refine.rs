//! Where planes near the hand do not tell the SCP: the search around, and what is felt where it leads nowhere.

use super::{FAR, FREED, Scp, Touch, row, tie_of};
use crate::depth::compromise::Compromise;
use crate::solid::{Covered, OnePlane, Pair, Placed, Sensed, Solids, facing_point};
use cspace::{BasicContact, CFace};
use spatial::{DVec3, Pose};

/// Rounds in which planes are taken anew at the SCP found.
const ROUNDS: usize = 12;
/// Most starts tried when the first leads nowhere, and looks around in one tick.
const STARTS: usize = 5;
const LOOKS: usize = 16;

impl Scp {
    /// The nearest touching configuration that a few starts lead to: the projection itself, the last SCP, and the foot on each
    /// pair's plane alone. If all are far from the hand and from the last SCP, the parts are wedged at this orientation: then
    /// what the planes near the hand agree on best, and false.
    pub(super) fn refine(&mut self, solids: &Solids, hip: &Pose, depth: f64) -> bool {
        if self.nearest.is_empty() {
            self.nearest.extend_from_slice(&self.touches);
        }
        let near = FAR * depth;
        // Parts that were wedged stay so until there is a way out near the hand.
        let limit = if self.wedged { near } else { near.max(2.0 * self.size) };
        self.looks = LOOKS;
        self.best.clear();
        let mut least = limit;
        if self.settle(solids, hip, false, least) {
            self.keep(&mut least);
        }
        let last = self.last.map(|p| p - hip.translation);
        if least > near {
            let foot = |t: &Touch| t.plane.normal_w * -t.plane.distance;
            let mut starts = [DVec3::ZERO; STARTS];
            let feet = self.nearest.iter().filter(|t| t.plane.distance < 0.0).map(foot);
            let count = starts.iter_mut().zip(last.into_iter().chain(feet)).map(|(to, from)| *to = from).count();
            for start in &starts[..count] {
                self.touches.clear();
                self.rows.clear();
                self.shift = *start;
                if self.settle(solids, hip, true, least) {
                    self.keep(&mut least);
                }
            }
        }
        std::mem::swap(&mut self.touches, &mut self.best);
        self.shift = self.touches.iter().map(|t| t.plane.normal_w * t.push).sum();
        let follows = last.is_none_or(|p| !self.wedged && self.shift.distance(p) <= near);
        let found = !self.touches.is_empty() && (least <= near || follows);
        if found {
            self.take_those_touched(solids, hip);
        } else {
            self.take_nearest();
            self.touch_unfelt(solids, &Placed::new(hip));
            self.rows.clear();
            self.rows.extend(self.touches.iter().map(|t| row(&t.plane)));
            self.give_way(FAR * self.depth_of_touches());
        }
        found
    }

    /// Of pieces whose edges go on in each other the plane of any may hold the SCP: takes the piece that the part touches there.
    fn take_those_touched(&mut self, solids: &Solids, hip: &Pose) {
        let Self { touches, around, shift, .. } = self;
        let there = Pose::new(hip.translation + *shift, hip.rotation);
        let placed = Placed::new(&there);
        let is_touched = |part: u32, piece: u32, plane: &CFace| {
            facing_point(&Pair::new(solids, part, piece, &placed), plane, FREED).is_some()
        };
        let mut looked = false;
        for i in 0..touches.len() {
            let t = &touches[i];
            let is_of_edges = matches!(t.plane.contact, BasicContact::TypeC { .. });
            if !(t.push > 0.0 && is_of_edges) || is_touched(t.part, t.piece, &t.plane) {
                continue;
            }
            if !std::mem::replace(&mut looked, true) {
                around.step(&there);
            }
            let other = around.pairs.iter().find(|s| {
                let plane = CFace { distance: s.near.distance - s.near.normal_w.dot(*shift), ..s.near };
                OnePlane::EXACT.holds_for(&t.plane, &plane)
                    && !touches.iter().any(|u| (u.part, u.piece) == (s.part, s.piece))
                    && is_touched(s.part, s.piece, &CFace { distance: 0.0, ..plane })
                    && Pair::of(solids, s, &placed).is_felt(&s.near, Covered::Unfelt)
            });
            if let Some(s) = other {
                let t = &mut touches[i];
                (t.part, t.piece, t.plane.contact) = (s.part, s.piece, s.near.contact);
                (t.tie, t.found_there) = (tie_of(solids), true);
            }
        }
    }

    /// Takes the planes nearest to the hand.
    pub(super) fn take_nearest(&mut self) {
        self.touches.clear();
        self.touches.extend_from_slice(&self.nearest);
    }

    /// The SCP becomes what the planes, whose rows are known, agree on best, no farther away than `limit`, metres.
    pub(super) fn give_way(&mut self, limit: f64) {
        let found = Compromise::of(&self.rows, &mut self.yielding);
        self.shift = found.z.clamp_length_max(limit);
        for (t, r) in self.touches.iter_mut().zip(&self.rows) {
            // What opposite planes ask for beyond their depths is the weight's, and no share of the force.
            t.push = found.multiplier(r).min(-t.plane.distance).max(0.0);
        }
    }

    fn keep(&mut self, least: &mut f64) {
        if self.shift.length() < *least {
            *least = self.shift.length();
            std::mem::swap(&mut self.touches, &mut self.best);
        }
    }

    /// Takes the planes anew at the SCP until they stay. With `fresh`, from the planes around the present SCP alone. True
    /// if the SCP penetrates nothing and is no farther than `limit`, metres.
    fn settle(&mut self, solids: &Solids, hip: &Pose, fresh: bool, limit: f64) -> bool {
        let mut fresh = fresh;
        for _ in 0..ROUNDS {
            if self.looks == 0 || self.shift.length() > limit {
                return false;
            }
            self.looks -= 1;
            let there = Pose::new(hip.translation + self.shift, hip.rotation);
            let (penetrates, changed) = self.look_around(solids, &there, std::mem::take(&mut fresh));
            if !changed {
                return !penetrates;
            }
            self.projection.solve(&self.rows);
            self.take_projection();
        }
        false
    }

    /// Replaces the planes of pairs that penetrate at the SCP's pose, and of pairs that hold it without touching it. Returns
    /// whether anything penetrates and whether any plane was replaced.
    fn look_around(&mut self, solids: &Solids, there: &Pose, all: bool) -> (bool, bool) {
        self.around.step(there);
        let placed = Placed::new(there);
        let (mut penetrates, mut changed) = (false, all);
        for i in 0..self.touches.len() {
            let t = &self.touches[i];
            let seen = |s: &Sensed| (s.part, s.piece) == (t.part, t.piece);
            if t.push > 0.0 && !self.around.pairs.iter().any(seen) {
                self.rows[i].offset = f64::NEG_INFINITY;
                changed = true;
            }
        }
        for k in 0..self.around.pairs.len() {
            let s = self.around.pairs[k];
            let known = self.touches.iter().position(|t| (t.part, t.piece) == (s.part, s.piece));
            // One plane that holds is proof enough, though the tracker there may be on another side.
            let held = |t: &Touch| t.plane.distance + t.plane.normal_w.dot(self.shift) >= -FREED;
            let inside = s.near.distance < -FREED && !known.is_some_and(|i| held(&self.touches[i]));
            let loose = s.near.distance > FREED && known.is_some_and(|i| self.touches[i].push > 0.0);
            penetrates |= inside;
            if !(inside || loose || all && known.is_none()) {
                continue;
            }
            let pair = Pair::of(solids, &s, &placed);
            let plane = if pair.is_felt(&s.near, Covered::Unfelt) {
                Some(s.near)
            } else {
                pair.felt_plane(&s.near, Covered::Felt, &mut self.hints[pair.part * self.pieces + pair.piece])
            };
            let plane = plane.map(|c| CFace { distance: c.distance - c.normal_w.dot(self.shift), ..c });
            match (known, plane) {
                (Some(i), Some(plane)) => {
                    changed |=
                        self.touches[i].plane.contact != plane.contact || self.rows[i].offset == f64::NEG_INFINITY;
                    self.touches[i].plane = plane;
                    self.touches[i].found_there = true;
                    self.rows[i] = row(&plane);
                }
                (None, Some(plane)) if self.touches.len() < self.touches.capacity() => {
                    self.touch(solids, s.part, s.piece, plane);
                    if let Some(t) = self.touches.last_mut() {
                        t.found_there = true;
                    }
                    changed = true;
                }
                (Some(i), None) if loose => {
                    self.rows[i].offset = f64::NEG_INFINITY;
                    changed = true;
                }
                _ => {}
            }
        }
        (penetrates, changed)
    }
}
