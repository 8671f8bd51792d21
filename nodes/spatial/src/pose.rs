use glam::{DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// A rigid transform `p_w = translation + rotation * p_a`: metres and a unit quaternion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Origin of the inner frame in the outer one, metres.
    pub translation: DVec3,
    /// Orientation of the inner frame in the outer one, unit quaternion.
    pub rotation: DQuat,
}

impl Pose {
    /// The identity transform.
    pub const IDENTITY: Self = Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY };

    /// A pose from its origin (metres) and orientation (unit quaternion).
    #[inline]
    #[must_use]
    pub const fn new(translation: DVec3, rotation: DQuat) -> Self {
        Self { translation, rotation }
    }

    /// Fixed-axis roll, pitch, yaw (`R = Rz(yaw) Ry(pitch) Rx(roll)`, radians), as URDF has them.
    #[must_use]
    pub fn from_xyz_rpy(xyz: DVec3, rpy: DVec3) -> Self {
        Self::new(xyz, DQuat::from_rotation_z(rpy.z) * DQuat::from_rotation_y(rpy.y) * DQuat::from_rotation_x(rpy.x))
    }

    /// The outer coordinates of the inner point `p`.
    #[inline]
    #[must_use]
    pub fn transform_point(&self, p: DVec3) -> DVec3 {
        self.translation + self.rotation * p
    }

    /// The outer components of the inner direction `v`.
    #[inline]
    #[must_use]
    pub fn transform_vector(&self, v: DVec3) -> DVec3 {
        self.rotation * v
    }

    /// The inverse transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { translation: -(rotation * self.translation), rotation }
    }

    /// Columns are the inner axes in the outer frame.
    #[inline]
    #[must_use]
    pub fn rotation_matrix(&self) -> DMat3 {
        DMat3::from_quat(self.rotation)
    }

    /// The rotation vector (radians, outer axes, angle in `[0, pi]`) that takes `self`'s orientation to `to`'s; exactly zero if
    /// they are the same.
    #[inline]
    #[must_use]
    pub fn rotation_to(&self, to: &Self) -> DVec3 {
        if self.rotation == to.rotation {
            return DVec3::ZERO;
        }
        let mut q = to.rotation * self.rotation.conjugate();
        if q.w < 0.0 {
            q = -q;
        }
        let s = DVec3::new(q.x, q.y, q.z);
        let w = q.w.max(1e-150);
        let square = s.length_squared() / (w * w);
        if square < 1e-3 {
            // atan(t) / t in powers of t^2: what is left out is less than rounding.
            let series = 1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0 - square * (1.0 / 7.0 - square / 9.0)));
            return s * (2.0 / w * series);
        }
        rotation_vector(s, q.w)
    }

    /// `self` moved by `dp` (metres) and turned by the rotation vector `dtheta` (radians), both along outer axes.
    #[must_use]
    pub fn moved(&self, dp: DVec3, dtheta: DVec3) -> Self {
        Self {
            translation: self.translation + dp,
            rotation: (DQuat::from_scaled_axis(dtheta) * self.rotation).normalize(),
        }
    }

    /// Straight line in position, shortest turn in orientation; `s` in `[0, 1]`.
    #[must_use]
    pub fn interpolate(&self, to: &Self, s: f64) -> Self {
        self.moved((to.translation - self.translation) * s, self.rotation_to(to) * s)
    }

    /// True if every number is finite and the quaternion's norm is within `1e-6` of one.
    #[inline]
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.translation.is_finite() && self.rotation.is_finite() && (self.rotation.length() - 1.0).abs() < 1e-6
    }
}

/// The rotation vector of a unit quaternion with `w >= 0`. By atan2: exact for small angles, where acos loses half the digits.
fn rotation_vector(s: DVec3, w: f64) -> DVec3 {
    let sin_half = s.length();
    s * (2.0 * sin_half.atan2(w) / sin_half)
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl std::ops::Mul for Pose {
    type Output = Self;
    /// `a_from_c = a_from_b * b_from_c`.
    fn mul(self, inner: Self) -> Self {
        Self { translation: self.transform_point(inner.translation), rotation: self.rotation * inner.rotation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_and_product_cancel() {
        let p = Pose::from_xyz_rpy(DVec3::new(1.0, -2.0, 3.0), DVec3::new(0.3, -0.2, 2.0));
        let e = p * p.inverse();
        assert!(e.translation.length() < 1e-15 * 10.0);
        assert!((e.rotation.w.abs() - 1.0).abs() < 1e-15 * 10.0);
    }

    #[test]
    fn interpolate_reaches_both_ends() {
        let a = Pose::from_xyz_rpy(DVec3::ZERO, DVec3::new(0.1, 0.2, -3.0));
        let b = Pose::from_xyz_rpy(DVec3::X, DVec3::new(-1.0, 0.2, 3.0));
        let end = a.interpolate(&b, 1.0);
        assert!(end.rotation_to(&b).length() < 1e-12 && (end.translation - b.translation).length() < 1e-15);
        assert!(a.interpolate(&b, 0.0).rotation_to(&a).length() < 1e-15);
    }

    #[test]
    fn rpy_is_fixed_axis() {
        // URDF: roll about x first, then pitch about the fixed y, then yaw about the fixed z.
        let p =
            Pose::from_xyz_rpy(DVec3::ZERO, DVec3::new(std::f64::consts::FRAC_PI_2, 0.0, std::f64::consts::FRAC_PI_2));
        assert!((p.transform_vector(DVec3::Y) - DVec3::Z).length() < 1e-12);
        assert!((p.transform_vector(DVec3::X) - DVec3::Y).length() < 1e-12);
    }
}
