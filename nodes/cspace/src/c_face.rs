use crate::BasicContact;
use spatial::DVec3;

/// A C-face at the present orientation: a basic contact and its supporting plane in C-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CFace {
    /// The basic contact that takes place on it.
    pub contact: BasicContact,
    /// Outward unit normal, axes of W.
    pub normal_w: DVec3,
    /// Signed distance of `x` to the plane `n.x = d`, metres; `< 0` inside the C-obstacle's half-space.
    pub distance: f64,
}
