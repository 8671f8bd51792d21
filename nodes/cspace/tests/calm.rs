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

/// Where a pair ceases to be applicable before it ceases to be calm, another Near takes over, of which nothing was said: boxes that lie
/// nearly flat on each other roll over their edges, now slowly, now fast.
#[test]
fn what_was_said_of_a_near_is_not_said_of_the_next() {
    let mut rng = random(5);
    let mut inside = 0;
    for round in 0..400 {
        let [a, b] = [(); 2].map(|()| {
            let size = DVec3::from_array(std::array::from_fn(|_| rng.random_range(0.01..0.04)));
            polyhedron(&cuboid(size))
        });
        let world = World { moving: vec![a.clone()], fixed: vec![FixedPart { polyhedron: b.clone(), obstacle: 0 }] };
        let mut all = BodyTracker::new(Arc::new(world), 0.05);
        let flat = DQuat::from_rotation_z(rng.random_range(-0.6..0.6));
        let [half_a, half_b] = [&a, &b].map(|p| p.vertices()[7]);
        let over = DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), 0.0) * half_b;
        let start = over + DVec3::Z * (half_a.z + half_b.z - rng.random_range(1e-6..1e-4));
        let (mut pose, mut dp, mut dr) = (Pose::new(start, flat), DVec3::ZERO, DVec3::ZERO);
        for tick in 0..200 {
            if tick % 8 == 0 {
                let step = 10.0_f64.powf(rng.random_range(-8.0..-4.5));
                (dp, dr) = (unit(&mut rng) * step, unit(&mut rng) * (step / a.size()));
            }
            pose = pose.moved(dp, dr);
            let found = all.step(&pose)[0].tracked;
            if found.divergent || found.distance > 0.0 {
                continue;
            }
            inside += 1;
            let least = exhaustive_distance(&a, &b, &pose);
            assert!((found.distance - least).abs() < 1e-12, "{round} {tick}: {found:?}, least {least}");
        }
    }
    assert!(inside > 20_000, "inside {inside}");
}

/// A peg turned about two axes in a hole that is too tight for it, as a trembling hand holds it: five pieces are penetrated deeply,
/// close to creases of their C-obstacles. What is known of them lasts for many ticks.
#[test]
fn a_jammed_peg_needs_few_looks_at_other_planes() {
    let piece = |low: [f64; 3], high: [f64; 3]| {
        let [low, high] = [low, high].map(|p| DVec3::from_array(p) * 1e-3);
        let polyhedron = polyhedron(&cuboid(high - low));
        let at = Pose::new(0.5 * (low + high), DQuat::IDENTITY);
        FixedPart { polyhedron: Arc::new(polyhedron.transformed(&at, 1.0)), obstacle: 0 }
    };
    let fixed = vec![
        piece([8.125, -25.0, -9.0], [30.0, 25.0, 0.0]),
        piece([-30.0, -25.0, -9.0], [-8.125, 25.0, 0.0]),
        piece([-8.125, 5.105, -9.0], [8.125, 25.0, 0.0]),
        piece([-8.125, -25.0, -9.0], [8.125, -5.105, 0.0]),
        piece([-30.0, -25.0, -14.0], [30.0, 25.0, -9.0]),
    ];
    let moving = vec![polyhedron(&cuboid(DVec3::new(0.016, 0.01, 0.03)))];
    let mut tracker = BodyTracker::new(Arc::new(World { moving, fixed }), 5e-3);
    let turned = Pose::new(DVec3::Z * 5.5e-3, DQuat::IDENTITY).moved(DVec3::ZERO, DVec3::new(0.0, 0.05, 0.06));
    let (mut planes, mut audits, mut inside) = (0, 0, 0);
    for tick in 0..2500 {
        let phase = f64::from(tick) * 0.01;
        let sway = DVec3::new(phase.sin(), phase.cos(), (1.3 * phase).sin()) * 5e-5;
        let tremor = DVec3::new((0.7 * phase).sin(), 0.0, (0.9 * phase).cos()) * 5e-3;
        // From above, and then trembling.
        let up = DVec3::Z * (0.03 * (1.0 - f64::from(tick) / 500.0).max(0.0));
        let found = tracker.step(&turned.moved(sway + up, tremor));
        if tick >= 500 {
            planes += found.iter().map(|p| p.tracked.planes).sum::<u32>();
            audits += found.iter().filter(|p| p.tracked.planes > 8).count();
            inside += found.iter().filter(|p| p.tracked.distance < 0.0).count();
        }
    }
    assert!(inside > 7_500, "{inside} contacts");
    assert!(audits < 20 && planes < 11_500, "{audits} long steps, {planes} planes in {inside} contacts");
}
