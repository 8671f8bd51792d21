//! A pair that is taken as calm for some ticks gives what a look at it in each would have given.

mod support;

use cspace::{BodyTracker, FixedPart, Tracker, World};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use std::sync::Arc;
use support::{Mesh, cuboid, exhaustive_distance, hull, polyhedron, prism, random, rotation, tetrahedron, unit};

#[test]
fn a_trembling_body_is_followed_as_by_a_tracker_that_always_looks() {
    let shapes: [Mesh; 5] = [
        cuboid(DVec3::new(0.02, 0.03, 0.01)),
        cuboid(DVec3::new(0.1, 0.1, 0.02)),
        prism(12, 0.02, 0.03),
        tetrahedron(0.015),
        hull(30, DVec3::new(0.02, 0.015, 0.02), 4),
    ];
    let mut rng = random(8);
    let (mut inside, mut differ) = (0, 0);
    for round in 0..300 {
        let [a, b] = [(); 2].map(|()| polyhedron(&shapes[rng.random_range(0..shapes.len())]));
        // Every other time aligned, or nearly so, as parts in a hand are.
        let turn = if round % 2 == 0 { rotation(&mut rng) } else { DQuat::IDENTITY };
        let little = DQuat::from_scaled_axis(unit(&mut rng) * 10.0_f64.powf(rng.random_range(-9.0..-1.0)));
        let rotation = (little * turn).normalize();
        let out = unit(&mut rng);
        // Onto the surface, and a little farther in.
        let (mut near, mut far) = (0.0, 0.2);
        for _ in 0..40 {
            let middle = 0.5 * (near + far);
            let is_free = exhaustive_distance(&a, &b, &Pose::new(out * middle, rotation)) > 0.0;
            (near, far) = if is_free { (near, middle) } else { (middle, far) };
        }
        let depth = 10.0_f64.powf(rng.random_range(-6.0..-3.0));
        let place = out * (near - depth);
        let (sway, tilt) = (10.0_f64.powf(rng.random_range(-6.0..-4.0)), 10.0_f64.powf(rng.random_range(-5.0..-2.5)));
        let axes = [(); 4].map(|()| unit(&mut rng));
        let world = World { moving: vec![a.clone()], fixed: vec![FixedPart { polyhedron: b.clone(), obstacle: 0 }] };
        let (mut all, mut one) = (BodyTracker::new(Arc::new(world), 0.05), Tracker::new(a.clone(), b.clone()));
        let mut phase = 0.0_f64;
        for tick in 0..150 {
            phase += if tick % 40 < 30 { 0.01 } else { 0.3 };
            let dp = axes[0] * (sway * phase.sin()) + axes[1] * (sway * (1.3 * phase).cos());
            let dr = axes[2] * (tilt * (0.7 * phase).sin()) + axes[3] * (tilt * (0.9 * phase).cos());
            let pose = Pose::new(place, rotation).moved(dp, dr);
            let expected = one.step(&pose);
            let found = all.step(&pose)[0].tracked;
            inside += usize::from(found.distance < 0.0);
            assert!((found.distance - expected.distance).abs() < 1e-15, "{round} {tick}: {found:?}, not {expected:?}");
            assert!(found.divergent <= expected.divergent, "{round} {tick}: {found:?}, not {expected:?}");
            if !found.divergent && found.distance < 0.0 && tick % 5 == 0 {
                let least = exhaustive_distance(&a, &b, &pose);
                assert!((found.distance - least).abs() < 1e-12, "{round} {tick}: {found:?}, least {least}");
            }
            differ += usize::from(found.near.contact != expected.near.contact);
        }
    }
    assert!(inside > 20_000 && differ == 0, "inside {inside}, another contact {differ}");
}
