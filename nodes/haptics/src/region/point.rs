//! What a contact region is made of, and which part of it is asked for.

use crate::solid::Pair;
use cspace::{BasicContact, CFace};
use spatial::DVec3;

/// Edges that cross at less than this angle (radians) have no reliable common normal: the face's is used.
pub(crate) const PARALLEL_EDGES: f64 = 0.02;
/// Contacts closer together than this part of the size are one.
const SAME_POINT: f64 = 1e-8;

/// A basic contact of the region: one of the paper's K contacts when it takes place, a potential one when it has a gap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionPoint {
    pub contact: BasicContact,
    /// How much of a contact it is, 0 to 1, where the scope is wide: see [`crate::solid::Solids::sharpness`].
    pub sharpness: f32,
    /// App_k, metres, W: on the surface of B.
    pub point_w: DVec3,
    /// Unit, axes of W, from B to A.
    pub normal_w: DVec3,
    /// Signed distance of A to B at this contact, metres, `< 0` is penetration: along the normal, or along Near's: see [`Scope`].
    pub gap: f64,
}

impl RegionPoint {
    /// The contact of a plane itself, at `point_w` on B.
    pub fn of(plane: &CFace, point_w: DVec3) -> Self {
        Self { contact: plane.contact, sharpness: 1.0, point_w, normal_w: plane.normal_w, gap: plane.distance }
    }

    /// A crossing of edges (unit directions, axes of W) whose place on A has moved by `motion`: the place slides along B's edge,
    /// the normal stays across both. One that has the face's normal keeps it.
    pub fn follow_crossing(&mut self, along_a: DVec3, along_b: DVec3, motion: DVec3) {
        let n = along_a.cross(along_b);
        let length = n.length();
        let lean = n.dot(self.normal_w);
        if length <= PARALLEL_EDGES || lean.abs() < 0.9999 * length {
            return;
        }
        self.point_w += along_b * (motion.cross(along_a).dot(n) / -(length * length));
        self.normal_w = n * (lean.signum() / length);
    }
}

/// Which contacts of a region are wanted, and seen in which direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scope {
    /// Contacts with a gap of up to this, metres: along their own normals, or along Near's if seen along it.
    pub reach: f64,
    /// Near's own contact, at its exact place.
    pub near_felt: bool,
    /// Not only of the two most nearly parallel faces, but of all that lean less than 60 degrees and come into reach.
    pub wide: bool,
    /// The faces are laid on each other along Near's normal, in which the crossing of Near's edges is exact; else along the
    /// normal of B's face, in which A's vertices touch it.
    pub along_near: bool,
}

/// Keeps a contact if there is room.
pub(crate) fn push_within(points: &mut Vec<RegionPoint>, p: RegionPoint) {
    if points.len() < points.capacity() {
        points.push(p);
    }
}

/// How far outside Near's features may face each other, metres.
pub(crate) fn own_tolerance(pair: &Pair<'_>) -> f64 {
    1e3 * same_place(pair)
}

/// Contacts closer together than this are one, metres.
pub(crate) fn same_place(pair: &Pair<'_>) -> f64 {
    SAME_POINT * (pair.a.size() + pair.b.size())
}
