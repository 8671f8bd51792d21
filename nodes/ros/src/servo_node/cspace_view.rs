use bag::basic_contact_to_msg;
use bag::msg::{CFace, Header, LocalCSpace};
use cspace::{ActivePair, BodyTracker, CFacePolygon, World};
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
    /// C-faces that are told of a pair at most, Near first: what lies beside it, whatever the size of the bodies.
    const MOST_FACES: usize = 100;

    /// For a world.
    #[must_use]
    pub fn new(world: &Arc<World>, frame_id: &str) -> Self {
        Self { tracker: BodyTracker::new(world.clone(), Self::MARGIN), frame_id: frame_id.to_owned() }
    }

    /// The neighbourhood of a tick.
    pub fn at(&mut self, tick: &TickRecord) -> LocalCSpace {
        self.tracker.step(&tick.hip);
        LocalCSpace {
            header: Header { stamp: tick.input.stamp.into(), frame_id: self.frame_id.clone() },
            sequence: tick.input.sequence,
            pose: tick.hip.into(),
            proxy_pose: tick.proxy.into(),
            depth: tick.depth,
            kind: tick.formation.kind as u8,
            c_faces: self.tracker.active().iter().flat_map(|pair| faces(&self.tracker, tick, pair)).collect(),
        }
    }
}

fn faces(tracker: &BodyTracker, tick: &TickRecord, pair: &ActivePair) -> Vec<CFace> {
    let near = &pair.tracked.near;
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
    let polygons = tracker.polygons_around_near(pair, &tick.hip, CSpaceView::MOST_FACES);
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

    /// A prism of many sides about z.
    fn prism(sides: u32, radius: f64) -> Arc<Polyhedron> {
        let corner = |i: u32, z: f64| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(sides)).sin_cos();
            DVec3::new(radius * cos, radius * sin, z)
        };
        let corners: Vec<DVec3> = [-0.01, 0.01].iter().flat_map(|z| (0..sides).map(|i| corner(i, *z))).collect();
        let mut faces: Vec<Vec<u32>> = vec![(0..sides).rev().collect(), (sides..2 * sides).collect()];
        faces.extend((0..sides).map(|i| vec![i, (i + 1) % sides, sides + (i + 1) % sides, sides + i]));
        Arc::new(Polyhedron::from_faces(&corners, &faces).unwrap())
    }

    #[test]
    fn near_of_large_parts_is_told_with_a_face_beyond_each_of_its_sides() {
        let fixed = vec![FixedPart { polyhedron: prism(300, 0.05), obstacle: 0 }];
        let world = Arc::new(World { moving: vec![prism(200, 0.02)], fixed });
        let mut view = CSpaceView::new(&world, "world");
        let hip =
            Pose::new(DVec3::new(0.0652, 0.024, 0.003), DQuat::from_rotation_x(0.1) * DQuat::from_rotation_y(-0.2));
        let told = view.at(&TickRecord { hip, proxy: hip, ..TickRecord::default() });
        let near = told.c_faces.iter().find(|f| f.near).unwrap();
        assert!(near.outline.len() >= 3 && told.c_faces.len() > near.outline.len());
        let point = |p: &bag::msg::Point| DVec3::new(p.x, p.y, p.z);
        for (i, p) in near.outline.iter().enumerate() {
            let ends = [point(p), point(&near.outline[(i + 1) % near.outline.len()])];
            let has_both =
                |f: &&CFace| !f.near && ends.iter().all(|end| f.outline.iter().any(|q| point(q).distance(*end) < 1e-9));
            assert_eq!(told.c_faces.iter().filter(has_both).count(), 1, "side {i}");
        }
    }
}
