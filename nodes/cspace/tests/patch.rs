//! The C-faces around Near, walked to from Near: the same polygons as the exhaustive way makes, and a bounded part of them
//! for bodies that it would take too long for.

mod support;

use cspace::{CFacePolygon, ContactGraph, Polyhedron, Tracker, c_face_polygons};
use spatial::{DQuat, DVec3, Pose};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
use support::{ball, cuboid, polyhedron, prism, random, rotation};

fn areas(polygons: &[CFacePolygon]) -> BTreeMap<Vec<(u32, u32)>, f64> {
    // By the corners' vertices: they name a face whatever the order of its contacts.
    let name = |p: &CFacePolygon| {
        let mut corners: Vec<(u32, u32)> = p.corners.iter().map(|(a, b)| (a.0, b.0)).collect();
        corners.sort_unstable();
        corners
    };
    polygons.iter().map(|p| (name(p), p.area())).collect()
}

fn check_whole(name: &str, tracker: &mut Tracker, turn: DQuat) {
    let pose = Pose::new(DVec3::new(0.01, -0.02, 0.08), turn);
    tracker.seed(&pose);
    let walked = tracker.polygons_around_near(&pose, usize::MAX);
    let all = c_face_polygons(tracker.moving(), tracker.fixed(), turn);
    assert_eq!(walked.len(), all.len(), "{name} at {turn}");
    let area = |polygons: &[CFacePolygon]| polygons.iter().map(CFacePolygon::area).sum::<f64>();
    let (area, expected) = (area(&walked), area(&all));
    assert!((area - expected).abs() < 1e-12 * expected.max(1.0), "{name} at {turn}: {area} instead of {expected}");
    let (contacts, expected): (BTreeSet<_>, BTreeSet<_>) =
        (walked.iter().map(|p| &p.contacts).collect(), all.iter().map(|p| &p.contacts).collect());
    assert_eq!(contacts, expected, "{name} at {turn}");
}

#[test]
fn walked_to_the_end_it_is_the_whole_obstacle() {
    let pairs = [
        ("box on box", cuboid(DVec3::new(0.02, 0.01, 0.06)), cuboid(DVec3::new(0.1, 0.08, 0.01))),
        ("prism on box", prism(7, 0.01, 0.03), cuboid(DVec3::new(0.1, 0.08, 0.01))),
        ("prism on prism", prism(12, 0.01, 0.03), prism(12, 0.05, 0.02)),
        ("ball on box", ball(60, 0.01), cuboid(DVec3::new(0.1, 0.08, 0.01))),
    ];
    let mut rng = random(11);
    for (name, a, b) in pairs {
        let mut tracker = Tracker::new(polyhedron(&a), polyhedron(&b));
        for _ in 0..50 {
            check_whole(name, &mut tracker, rotation(&mut rng));
        }
        for i in 0..64u32 {
            let quarter = |i: u32| f64::from(i & 3) * FRAC_PI_2;
            let aligned = DQuat::from_euler(glam::EulerRot::ZYX, quarter(i >> 4), quarter(i >> 2), quarter(i));
            check_whole(name, &mut tracker, aligned);
            check_whole(name, &mut tracker, DQuat::from_rotation_z(0.3) * aligned);
            check_whole(name, &mut tracker, DQuat::from_rotation_x(0.7) * aligned);
        }
    }
}

/// No vertex of the C-obstacle lies beyond the plane.
fn assert_supports(a: &Polyhedron, b: &Polyhedron, turn: DQuat, polygon: &CFacePolygon) {
    let n = polygon.normal_w;
    let far = b.vertex(b.support(n)) - turn * a.vertex(a.support(turn.inverse() * -n));
    assert!(polygon.distance(far) < 1e-12, "{:?}: {}", polygon.contacts, polygon.distance(far));
}

fn check_large(faces: usize, most: usize) {
    let a = polyhedron(&ball(faces, 0.02));
    let b: Arc<Polyhedron> = polyhedron(&ball(faces, 0.05));
    let mut tracker = Tracker::new(a.clone(), b.clone());
    let mut rng = random(3);
    for _ in 0..3 {
        let pose = Pose::new(support::unit(&mut rng) * 0.069, rotation(&mut rng));
        let near = tracker.seed(&pose).near;
        let begun = std::time::Instant::now();
        let patch = tracker.polygons_around_near(&pose, most);
        let spent = begun.elapsed();
        println!("{} faces each: {} polygons in {spent:?}", a.face_count(), patch.len());
        assert_eq!(patch.len(), most);
        let home = patch.iter().position(|p| p.contacts == [near.contact]).expect("Near is among them");
        for polygon in &patch {
            assert_supports(&a, &b, pose.rotation, polygon);
        }
        // All neighbours of Near, and nothing that hangs on nothing.
        for neighbor in ContactGraph::new(&a, &b).facet_neighbors(near.contact, &pose) {
            assert!(patch.iter().any(|p| p.contacts.contains(&neighbor)), "{neighbor:?} is missing");
        }
        let mut reached = BTreeSet::from([home]);
        let mut last = 0;
        while reached.len() > last {
            last = reached.len();
            let next: Vec<usize> =
                (0..patch.len()).filter(|&i| reached.iter().any(|&j| patch[i].is_neighbor(&patch[j]))).collect();
            reached.extend(next);
        }
        assert_eq!(reached.len(), patch.len());
        assert_eq!(areas(&patch).len(), most, "a face is there twice");
    }
}

#[test]
fn a_part_of_2_000_faces_shows_what_is_around_near() {
    check_large(2_000, 200);
}

#[test]
fn a_part_of_20_000_faces_shows_what_is_around_near() {
    check_large(20_000, 200);
}

#[test]
fn before_the_first_step_there_is_nothing() {
    let tracker = Tracker::new(polyhedron(&ball(30, 0.01)), polyhedron(&ball(30, 0.02)));
    assert!(tracker.polygons_around_near(&Pose::IDENTITY, 10).is_empty());
}
