//! Pairs within a margin that differs from step to step: all of them, whatever the margins before were, and no others.

mod support;

use cspace::{BodyTracker, FixedPart, World};
use rand::RngExt;
use spatial::{DVec3, Pose};
use std::sync::Arc;
use support::*;

#[test]
fn a_margin_of_its_own_for_each_step_misses_no_pair() {
    let mut rng = random(3);
    let body = cuboid(DVec3::new(0.8, 0.5, 1.0));
    let obstacles: Vec<(Mesh, Pose)> = (0..12)
        .map(|k| (hull(16, DVec3::splat(0.4), k), Pose::new(unit(&mut rng) * 1.3, rotation(&mut rng))))
        .collect();
    let place = |(mesh, at): &(Mesh, Pose)| FixedPart {
        polyhedron: Arc::new(polyhedron(mesh).transformed(at, 1.0)),
        obstacle: 0,
    };
    let world = Arc::new(World { moving: vec![polyhedron(&body)], fixed: obstacles.iter().map(place).collect() });
    let (shape, shapes) = (parry_shape(&body), obstacles.iter().map(|(mesh, _)| parry_shape(mesh)).collect::<Vec<_>>());
    let most = 0.3;
    let mut tracker = BodyTracker::new(world, most);
    let (mut close, mut far) = (0, 0);
    for i in 0..1500 {
        let t = f64::from(i) * 4e-3;
        let sway = DVec3::new((2.0 * t).sin(), (1.3 * t).cos(), (1.7 * t).sin()) * 0.5;
        let pose = Pose::IDENTITY.moved(sway, DVec3::new(0.4 * t, (0.7 * t).sin(), 0.3));
        let margin = if i % 7 == 0 { 2.0 * most } else { most * rng.random_range(0.0..1.0_f64).powi(2) };
        let found = tracker.step_within(&pose, margin);
        let margin = margin.min(most);
        assert!(found.iter().all(|p| p.tracked.distance <= margin), "step {i}");
        for (k, (other, (_, at))) in shapes.iter().zip(&obstacles).enumerate() {
            // A plane's signed distance is no more than the distance of the bodies.
            if parry_distance(&shape, other, &(at.inverse() * pose), 0.99 * margin).is_some() {
                assert!(found.iter().any(|p| p.piece as usize == k), "step {i}: {k} is missed within {margin}");
                close += 1;
            } else {
                far += 1;
            }
        }
    }
    assert!(close > 1000 && far > 1000, "{close} close, {far} far");
}
