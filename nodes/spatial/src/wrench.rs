use crate::Twist;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Force and torque ON THE HAND: N and N.m, axes of W, torque about the origin of A.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// N, axes of W.
    pub force: DVec3,
    /// N.m, axes of W, about the origin of A.
    pub torque: DVec3,
}

impl Wrench {
    /// No force, no torque.
    pub const ZERO: Self = Self { force: DVec3::ZERO, torque: DVec3::ZERO };

    /// A wrench from its force (N) and torque (N.m).
    #[must_use]
    pub const fn new(force: DVec3, torque: DVec3) -> Self {
        Self { force, torque }
    }

    /// True if every number is finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.force.is_finite() && self.torque.is_finite()
    }

    /// Power given to the hand that moves with `twist`, W.
    #[must_use]
    pub fn power(&self, twist: &Twist) -> f64 {
        self.force.dot(twist.linear) + self.torque.dot(twist.angular)
    }

    /// The same wrench about another point: `shift` leads from the old reference point to the new one (m, axes of W).
    #[must_use]
    pub fn about(&self, shift: DVec3) -> Self {
        Self { force: self.force, torque: self.torque - shift.cross(self.force) }
    }
}

impl std::ops::Add for Wrench {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { force: self.force + o.force, torque: self.torque + o.torque }
    }
}

impl std::ops::Sub for Wrench {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { force: self.force - o.force, torque: self.torque - o.torque }
    }
}

impl std::ops::Mul<f64> for Wrench {
    type Output = Self;
    fn mul(self, s: f64) -> Self {
        Self { force: self.force * s, torque: self.torque * s }
    }
}

impl std::ops::Neg for Wrench {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torque_of_a_force_through_the_new_point_vanishes() {
        let p = DVec3::new(0.1, 0.2, 0.3);
        let f = DVec3::new(1.0, -2.0, 0.5);
        let about_origin = Wrench::new(f, p.cross(f));
        assert!(about_origin.about(p).torque.length() < 1e-15);
    }
}
