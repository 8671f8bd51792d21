use crate::CFace;

/// What a step of the tracker says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// The tracked C-face: the one with the largest signed distance among itself and its neighbours, kept continuously
    /// so that it is on the side by which A came in.
    pub near: CFace,
    /// Penetration to Near's plane, metres, `>= 0`; 0 when free.
    pub depth: f64,
    /// Signed distance of `x` to Near's plane, metres: `> 0` proves freedom, `<= 0` is contact. When free it is a lower
    /// bound of the distance between the bodies.
    pub distance: f64,
    /// In contact, and some other plane is nearer than Near's, or that could not be excluded within the step's budget.
    pub divergent: bool,
    /// Near was not reached continuously: a global seed, a jump too long to follow, or the release after a pass
    /// through the whole obstacle.
    pub reseeded: bool,
    /// Planes and supports looked at in this step.
    pub planes: u32,
}

impl Tracked {
    /// Near as it was, with nothing more to say.
    #[inline]
    pub(crate) fn quick(near: CFace) -> Self {
        let distance = near.distance;
        Self { near, depth: (-distance).max(0.0), distance, divergent: false, reseeded: false, planes: 1 }
    }

    /// Whether no contact takes place.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.distance > 0.0
    }
}
