//! Planes of several pairs that are one: the pieces of a solid touch there together.

use super::scp::Touch;
use crate::region::TIED;
use crate::solid::OnePlane;

/// Of the size that a tie tells.
const PER_TIE: f64 = 1.0 / TIED;
/// Planes that differ by less, in parts of the tie, are equally deep.
const ROUNDING: f64 = 1e-3;

/// The signed distance, metres, of the deepest plane that is one with this and has contacts, and how many are.
#[inline]
pub(super) fn deepest_of_equals(touches: &[Touch], i: usize) -> (f64, usize) {
    let t = &touches[i];
    let one_region = one_region(t);
    let equals = touches.iter().filter(|u| u.first < u.end && one_region.holds_for(&t.plane, &u.plane));
    equals.fold((f64::INFINITY, 0), |(deepest, count), u| (u.left.min(deepest), count + 1))
}

/// Whether there is a deeper plane that is one with this.
pub(super) fn is_above_its_equals(touches: &[Touch], i: usize) -> bool {
    let t = &touches[i];
    let one_region = one_region(t);
    touches.iter().any(|u| u.left < t.left - ROUNDING * t.tie && one_region.holds_for(&t.plane, &u.plane))
}

/// Whether two planes are one constraint.
pub(super) fn is_equal(t: &Touch, u: &Touch) -> bool {
    one_region(t).holds_for(&t.plane, &u.plane)
}

/// How far planes may differ that have one contact region with this.
#[inline]
pub(super) fn one_region(t: &Touch) -> OnePlane {
    OnePlane::REGION.of_size(t.tie * PER_TIE)
}
