//! The nearest C-face of every pair in reach of a pose.

use cspace::{BodyTracker, CFace, World};
use spatial::Pose;
use std::sync::Arc;

/// A pair in reach and its nearest C-face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensed {
    pub part: u32,
    pub piece: u32,
    pub near: CFace,
}

/// The tracker of all pairs, in the laws' terms.
#[derive(Debug)]
pub(crate) struct Sense {
    tracker: BodyTracker,
    /// Pairs within the margin at the last pose.
    pub pairs: Vec<Sensed>,
    /// Some pair lost its object and was seeded anew.
    pub reseeded: bool,
    /// Some pair's tracked depth is not the global minimum.
    pub divergent: bool,
}

impl Sense {
    /// Reports pairs up to `margin` metres apart.
    pub fn new(world: Arc<World>, margin: f64) -> Self {
        let pairs = world.moving.len() * world.fixed.len();
        Self {
            tracker: BodyTracker::new(world, margin),
            pairs: Vec::with_capacity(pairs),
            reseeded: false,
            divergent: false,
        }
    }

    pub fn reset(&mut self) {
        self.tracker.reset();
    }

    pub fn step(&mut self, pose: &Pose) {
        self.step_within(pose, f64::INFINITY);
    }

    /// Reports pairs up to `margin` metres apart, if that is less.
    pub fn step_within(&mut self, pose: &Pose, margin: f64) {
        self.pairs.clear();
        self.reseeded = false;
        self.divergent = false;
        for active in self.tracker.step_within(pose, margin) {
            let t = &active.tracked;
            self.pairs.push(Sensed { part: active.part, piece: active.piece, near: t.near });
            self.reseeded |= t.reseeded;
            self.divergent |= t.divergent;
        }
    }
}
