//! The pose of A in the form the geometry wants.

use spatial::{DMat3, DVec3, Pose};

/// The pose of A in the form the geometry wants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub x: DVec3,
    pub r: DMat3,
}

impl Placed {
    pub fn new(pose: &Pose) -> Self {
        Self { x: pose.translation, r: pose.rotation_matrix() }
    }

    /// The same orientation, moved by `by`, axes of W.
    pub fn shifted(&self, by: DVec3) -> Self {
        Self { x: self.x + by, r: self.r }
    }

    pub fn point(&self, p: DVec3) -> DVec3 {
        self.x + self.r * p
    }

    /// A point of W as A sees it.
    pub fn seen_from_a(&self, p: DVec3) -> DVec3 {
        self.r.transpose() * (p - self.x)
    }
}
