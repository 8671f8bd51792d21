//! When two planes are one but for rounding.

use cspace::CFace;
use spatial::DVec3;

/// How far two planes that are one may differ. One notion, with three tolerances, since three things ask for it:
///
/// * [`OnePlane::EXACT`]: rows of one projection, where an equal row adds nothing. Only what double precision makes of one plane is one,
///   for what differs by more pushes by that much more.
/// * [`OnePlane::WALL`]: faces of pieces that the proxy lets go of together. Files of single precision hold them no closer together, and
///   one piece alone that gives way frees nothing.
/// * [`OnePlane::REGION`]: planes whose contacts are one contact region, by which alone their torque is found: as far apart, in parts of
///   the size, as contacts may lie that take place together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnePlane {
    /// Radians.
    normals: f64,
    /// Metres, or parts of the size.
    pub offsets: f64,
}

impl OnePlane {
    pub const EXACT: Self = Self { normals: 1e-9, offsets: 1e-9 };
    pub const WALL: Self = Self { normals: 1e-5, offsets: 1e-7 };
    pub const REGION: Self = Self { normals: 4e-6, offsets: 4e-6 };

    /// The same where offsets are told in parts of `size`, metres.
    pub fn of_size(self, size: f64) -> Self {
        Self { offsets: self.offsets * size, ..self }
    }

    /// Whether planes with these unit normals and offsets (metres) are one.
    #[inline]
    pub fn holds(self, (normal, offset): (DVec3, f64), (other, other_offset): (DVec3, f64)) -> bool {
        (offset - other_offset).abs() <= self.offsets && normal.distance_squared(other) <= self.normals * self.normals
    }

    /// The same of the planes of contacts, at one pose.
    #[inline]
    pub fn holds_for(self, c: &CFace, d: &CFace) -> bool {
        self.holds((c.normal_w, c.distance), (d.normal_w, d.distance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_one_within_the_tolerance_of_what_asks() {
        let turned = |by: f64| (DVec3::new(by, 0.0, 1.0).normalize(), 0.02);
        let raised = |by: f64| (DVec3::Z, 0.02 + by);
        let all = [OnePlane::EXACT, OnePlane::WALL, OnePlane::REGION.of_size(0.05)];
        assert_eq!(all.map(|p| p.holds(raised(0.0), turned(0.9e-9))), [true; 3]);
        assert_eq!(all.map(|p| p.holds(raised(0.0), turned(1e-6))), [false, true, true]);
        assert_eq!(all.map(|p| p.holds(raised(0.0), turned(8e-6))), [false, true, false]);
        assert_eq!(all.map(|p| p.holds(raised(1.5e-7), turned(0.0))), [false, false, true]);
        assert_eq!(all.map(|p| p.holds(raised(3e-7), turned(0.0))), [false; 3]);
    }
}
