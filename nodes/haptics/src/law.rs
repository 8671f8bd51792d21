use crate::{ContactFormation, Gains};
use spatial::{Pose, Wrench};

/// What a law makes of one pose of the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawOutput {
    /// The law's own wrench, before coupling damping, ramp, passivity and limits.
    pub wrench: Wrench,
    /// The surface contact pose, A in W: what a robot should follow. Equal to the hand's pose when free.
    pub proxy: Pose,
    /// Penetration of the hand's pose, metres, `>= 0`; the largest over all pairs.
    pub depth: f64,
    /// Elastic energy held by the law, J.
    pub energy: f64,
    /// The contacts that take place.
    pub formation: ContactFormation,
    /// Basic contacts that took place but found no room in `formation`.
    pub dropped: u32,
    /// A pair lost its object and was seeded anew, or the pose jumped.
    pub reseeded: bool,
    /// Another law than in the last tick: the proxy may be elsewhere without any motion.
    pub changed: bool,
    /// The tracked depth is not the global minimum (the side by which the tool came in is kept).
    pub divergent: bool,
}

impl LawOutput {
    /// Of a hand at `pose` that touches nothing.
    #[must_use]
    pub fn free(pose: Pose) -> Self {
        Self {
            wrench: Wrench::ZERO,
            proxy: pose,
            depth: 0.0,
            energy: 0.0,
            formation: ContactFormation::FREE,
            dropped: 0,
            reseeded: false,
            changed: false,
            divergent: false,
        }
    }
}

/// Renders contact: owns trackers and scratch, allocates at construction only.
pub trait RenderLaw: Send {
    /// One tick: the hand's pose of A in W, the gains and the time since the last tick (s). Bounded; no allocation.
    fn render(&mut self, hip: &Pose, gains: &Gains, dt: f64) -> LawOutput {
        let mut out = LawOutput::free(*hip);
        self.render_into(hip, gains, dt, &mut out);
        out
    }

    /// The same, into the output of a hand that touches nothing: what a tick gives is large to hand on.
    fn render_into(&mut self, hip: &Pose, gains: &Gains, dt: f64, out: &mut LawOutput);
    /// Forgets the past: the next pose is seeded globally.
    fn reset(&mut self);
}
