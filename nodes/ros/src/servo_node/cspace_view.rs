use bag::basic_contact_to_msg;
use bag::msg::{CFace, Header, LocalCSpace};
use cspace::{ActivePair, BodyTracker, CFacePolygon, World, c_face_polygons};
use servo::TickRecord;
use std::sync::Arc;

/// C-space around the hand as a message: Near of every pair and the C-faces beside it, with their outlines. Follows the
/// hand with a tracker of its own, out of the loop's way.
pub struct CSpaceView {
    tracker: BodyTracker,
    frame_id: String,
}

impl CSpaceView {
    /// Pairs nearer than this are told, metres.
    const MARGIN: f64 = 0.005;
    /// Outlines cost as much as there are pairs of features: beyond this many only Near is told.
    const MOST_FACES: usize = 4000;

    /// For a world.
    #[must_use]
    pub fn new(world: &Arc<World>, frame_id: &str) -> Self {
        Self { tracker: BodyTracker::new(world.clone(), Self::MARGIN), frame_id: frame_id.to_owned() }
    }

    /// The neighbourhood of a tick.
    pub fn at(&mut self, tick: &TickRecord) -> LocalCSpace {
        let world = self.tracker.world().clone();
        let pairs = self.tracker.step(&tick.hip).to_vec();
        LocalCSpace {
            header: Header { stamp: tick.input.stamp.into(), frame_id: self.frame_id.clone() },
            sequence: tick.input.sequence,
            pose: tick.hip.into(),
            proxy_pose: tick.proxy.into(),
            depth: tick.depth,
            kind: tick.formation.kind as u8,
            c_faces: pairs.iter().flat_map(|pair| faces(&world, tick, pair)).collect(),
        }
    }
}

fn faces(world: &World, tick: &TickRecord, pair: &ActivePair) -> Vec<CFace> {
    let near = &pair.tracked.near;
    let (a, b) = (&world.moving[pair.part as usize], &world.fixed[pair.piece as usize].polyhedron);
    let message = |polygon: Option<&CFacePolygon>, is_near: bool| {
        let contact = if is_near { near.contact } else { polygon.map_or(near.contact, |p| p.contacts[0]) };
        let in_contact = tick.formation.points().iter().any(|p| {
            (p.part_a, p.piece_b) == (pair.part, pair.piece)
                && (p.contact == contact || polygon.is_some_and(|g| g.contacts.contains(&p.contact)))
        });
        CFace {
            part_a: pair.part,
            piece_b: pair.piece,
            contact: basic_contact_to_msg(&contact),
            normal: polygon.map_or(near.normal_w, |p| p.normal_w).into(),
            distance: polygon.map_or(near.distance, |p| p.distance(tick.hip.translation)),
            near: is_near,
            in_contact,
            outline: polygon.map_or(Vec::new(), |p| p.vertices.iter().map(|v| (*v).into()).collect()),
        }
    };
    if a.face_count() * b.face_count() > CSpaceView::MOST_FACES {
        return vec![message(None, true)];
    }
    let polygons = c_face_polygons(a, b, tick.hip.rotation);
    let Some(home) = polygons.iter().find(|p| p.contacts.contains(&near.contact)) else {
        return vec![message(None, true)];
    };
    let beside = polygons.iter().filter(|p| home.is_neighbor(p) && *p != home);
    std::iter::once(message(Some(home), true)).chain(beside.map(|p| message(Some(p), false))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cspace::{FixedPart, Polyhedron};
    use spatial::{DQuat, DVec3, Pose};

    fn cube(half: f64) -> Arc<Polyhedron> {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) * 2.0 - 1.0;
        let corners: Vec<DVec3> = (0..8).map(|i| corner(i) * half).collect();
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|f| f.to_vec());
        Arc::new(Polyhedron::from_faces(&corners, &faces).unwrap())
    }

    #[test]
    fn near_is_told_with_the_faces_beside_it() {
        let world = Arc::new(World {
            moving: vec![cube(0.01)],
            fixed: vec![FixedPart { polyhedron: cube(0.05), obstacle: 0 }],
        });
        let mut view = CSpaceView::new(&world, "world");
        let hip = Pose::new(DVec3::new(0.0, 0.0, 0.062), DQuat::IDENTITY);
        let tick = TickRecord { hip, proxy: hip, ..TickRecord::default() };
        let told = view.at(&tick);
        let near: Vec<&CFace> = told.c_faces.iter().filter(|f| f.near).collect();
        assert_eq!(near.len(), 1);
        assert!((near[0].distance - 0.002).abs() < 1e-12 && near[0].normal.z > 0.999);
        // Face on face of two cubes: the C-face is the square of their sum, and four lie beside it.
        assert_eq!((near[0].outline.len(), told.c_faces.len()), (4, 5));
        assert!(near[0].outline.iter().all(|p| (p.z - 0.06).abs() < 1e-12 && (p.x.abs() - 0.06).abs() < 1e-12));
        let far = Pose::new(DVec3::new(0.0, 0.0, 0.2), DQuat::IDENTITY);
        assert!(view.at(&TickRecord { hip: far, ..tick }).c_faces.is_empty());
    }
}
