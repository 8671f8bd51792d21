use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Velocity of A's frame: m/s of its origin and rad/s, both in axes of W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// Velocity of the origin of A, m/s, axes of W.
    pub linear: DVec3,
    /// Angular velocity, rad/s, axes of W.
    pub angular: DVec3,
}

impl Twist {
    /// At rest.
    pub const ZERO: Self = Self { linear: DVec3::ZERO, angular: DVec3::ZERO };

    /// True if every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.linear.is_finite() && self.angular.is_finite()
    }
}
