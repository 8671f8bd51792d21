use cspace::{CFacePolygon, Tracker, World, c_face_polygons};
use spatial::Pose;
use std::collections::BTreeMap;

/// Pairs with more pairs of faces than this are drawn in part: all their C-faces would take longer than a frame.
const WHOLE: usize = 4000;
/// C-faces that are drawn of such a pair.
const MOST: usize = 200;

/// The C-face polygons of every pair: all of them, or for large bodies those around Near.
pub(crate) struct Pairs {
    /// Of the large pairs, by part and piece.
    trackers: BTreeMap<(usize, usize), Tracker>,
}

impl Pairs {
    pub(crate) fn new(world: &World) -> Self {
        let mut trackers = BTreeMap::new();
        for (part, a) in world.moving.iter().enumerate() {
            for (piece, fixed) in world.fixed.iter().enumerate() {
                let b = &fixed.polyhedron;
                if a.face_count() * b.face_count() > WHOLE {
                    trackers.insert((part, piece), Tracker::new(a.clone(), b.clone()));
                }
            }
        }
        Self { trackers }
    }

    /// Whether all C-faces of a pair are drawn.
    pub(crate) fn is_whole(&self, part: usize, piece: usize) -> bool {
        !self.trackers.contains_key(&(part, piece))
    }

    /// The polygons of one pair with A at `pose`, which must be valid. Of a large pair none if its C-obstacle is farther
    /// than `reach` (metres) from `x`.
    pub(crate) fn polygons(
        &mut self,
        world: &World,
        (part, piece): (usize, usize),
        pose: &Pose,
        reach: f64,
    ) -> Vec<CFacePolygon> {
        let Some(tracker) = self.trackers.get_mut(&(part, piece)) else {
            return c_face_polygons(&world.moving[part], &world.fixed[piece].polyhedron, pose.rotation);
        };
        let near = tracker.step(pose);
        if near.distance > reach { Vec::new() } else { tracker.polygons_around_near(pose, MOST) }
    }
}
