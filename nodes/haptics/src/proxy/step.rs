//! A small motion of the proxy.

use spatial::{DVec3, Wrench};

/// A small motion of the proxy: translation (m) and rotation vector (rad), axes of W.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub dp: DVec3,
    pub dtheta: DVec3,
}

impl Step {
    pub const NONE: Self = Self { dp: DVec3::ZERO, dtheta: DVec3::ZERO };

    /// The same, made `s` times as long.
    pub fn scaled(self, s: f64) -> Self {
        Self { dp: self.dp * s, dtheta: self.dtheta * s }
    }

    /// What `wrench` gives to the body on the way, J.
    pub fn work(&self, wrench: &Wrench) -> f64 {
        wrench.force.dot(self.dp) + wrench.torque.dot(self.dtheta)
    }

    /// Largest way of a point of the body, metres.
    pub fn way(&self, lever: f64) -> f64 {
        self.dp.length() + lever * self.dtheta.length()
    }
}
