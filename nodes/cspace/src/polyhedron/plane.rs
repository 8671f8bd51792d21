use spatial::DVec3;

/// The plane `normal . p = distance` of a face, its normal unit and outward, in the polyhedron's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Signed distance of the plane from the origin along `normal`, metres.
    pub distance: f64,
}

impl Plane {
    /// Signed distance of `p` to the plane, metres; `< 0` on the body's side.
    #[must_use]
    pub fn signed_distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.distance
    }
}
