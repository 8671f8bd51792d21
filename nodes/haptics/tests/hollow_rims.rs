//! The proxy where a rim of pieces is hollow, where contacts of different normals meet in a point, and where a face lies along an
//! edge: it stays where the coupling is relaxed, so that no energy comes from nowhere.

mod support;

use cspace::{FixedPart, Polyhedron, World};
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use std::f64::consts::TAU;
use std::sync::Arc;
use support::{block, cuboid, mm, penetration, random, world};

/// An upright prism of `n` sides about the z axis, radius and z from and to in mm.
fn prism(n: usize, radius: f64, z: [f64; 2]) -> Polyhedron {
    let ring = |z: f64| {
        (0..n).map(move |k| {
            let turn = TAU * k as f64 / n as f64;
            mm(radius * turn.cos(), radius * turn.sin(), z)
        })
    };
    let vertices: Vec<DVec3> = ring(z[0]).chain(ring(z[1])).collect();
    let n = n as u32;
    let sides = (0..n).map(|k| vec![k, (k + 1) % n, n + (k + 1) % n, n + k]);
    let faces = [(0..n).rev().collect(), (n..2 * n).collect()].into_iter().chain(sides).collect::<Vec<_>>();
    Polyhedron::from_faces(&vertices, &faces).expect("a prism is a polyhedron")
}

/// A plate with a hole of `n` sides and the given radius, mm, in `n` pieces; its top at z = 0.
fn hole(n: usize, radius: f64) -> Vec<Polyhedron> {
    let corner = |k: usize, radius: f64, z: f64| {
        let turn = TAU * k as f64 / n as f64;
        mm(radius * turn.cos(), radius * turn.sin(), z)
    };
    let piece = |k: usize| {
        let ring = |z| [corner(k, radius, z), corner(k, 30.0, z), corner(k + 1, 30.0, z), corner(k + 1, radius, z)];
        let vertices: Vec<DVec3> = ring(-20.0).into_iter().chain(ring(0.0)).collect();
        let faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
        Polyhedron::from_faces(&vertices, &faces.map(Vec::from)).expect("a block is a polyhedron")
    };
    (0..n).map(piece).collect()
}

/// A prism of 64 sides that lies along the y axis, an edge or a side on top at z = 0.
fn lying_cylinder() -> Polyhedron {
    let lying = Pose::new(DVec3::NEG_Z * 0.1, DQuat::from_rotation_x(TAU / 4.0));
    random::placed(&prism(64, 100.0, [-400.0, 400.0]), &lying)
}

/// The most energy that came from nowhere in one tick, J, of the most that the coupling held; from the second tick on.
fn created(w: &Arc<World>, path: &dyn Fn(f64) -> Pose, n: u32) -> (f64, f64) {
    created_with(&Gains { law: LawKind::Proxy, proxy_speed: f64::INFINITY, ..Gains::default() }, w, path, n)
}

/// The same with these gains.
fn created_with(gains: &Gains, w: &Arc<World>, path: &dyn Fn(f64) -> Pose, n: u32) -> (f64, f64) {
    let mut r = Renderer::new(w.clone());
    let first = path(0.0);
    for i in 0..=1000 {
        let above = DVec3::Z * 10e-3 * (1.0 - f64::from(i) / 1e3);
        r.render(&Pose::new(first.translation + above, first.rotation), gains, 1e-3);
    }
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    let mut last = None;
    for i in 0..=n {
        let p = path(f64::from(i) / f64::from(n));
        let out = r.render(&p, gains, 1e-3);
        if i % 50 == 0 {
            let depth = penetration(w, &out.proxy);
            assert!(depth <= 1e-7, "tick {i}: the proxy is {depth} m deep");
        }
        if let Some((q, wrench, energy)) = last.replace((p, out.wrench, out.energy)) {
            let (q, mean): (Pose, _) = (q, (wrench + out.wrench) * 0.5);
            let done = mean.force.dot(p.translation - q.translation) + mean.torque.dot(q.rotation_to(&p));
            worst = worst.max(out.energy - energy + done);
        }
        most = most.max(out.energy);
    }
    (worst, most)
}

#[test]
fn a_peg_led_around_the_rim_of_a_round_hole_feels_no_joint() {
    let w = world(prism(12, 6.0, [-12.0, 12.0]), hole(24, 8.0));
    for tilt in [0.2, 0.45, 0.7] {
        let path = |s: f64| {
            let (c, d) = ((0.6 * s).cos(), (0.6 * s).sin());
            let turn = DQuat::from_scaled_axis(DVec3::new(-d, c, 0.0) * tilt) * DQuat::from_rotation_z(0.3 * s);
            Pose::new(mm(3.5 * c, 3.5 * d, 6.0 - 8.0 * tilt), turn)
        };
        let (worst, most) = created(&w, &path, 1500);
        assert!(most > 1e-4, "{tilt} rad: in contact ({most} J)");
        assert!(worst < 1e-7, "{tilt} rad: {worst} J from nowhere, of {most} J");
    }
}

#[test]
fn a_prism_that_slides_along_another_over_its_edges_feels_them_all_at_once() {
    // Lying across: at a corner of the one an edge of the other crosses two of its edges in one point.
    let w = world(prism(64, 60.0, [-80.0, 80.0]), vec![lying_cylinder()]);
    let path = |s: f64| {
        let turn = DQuat::from_scaled_axis(DVec3::new(0.05 * s, 0.03, 0.02 * s));
        Pose::new(mm(-6.0 + 12.0 * s, 1.0 - 3.0 * s, 76.0 + 0.5 * s), turn)
    };
    let (worst, most) = created(&w, &path, 1500);
    assert!(most > 1e-4, "in contact ({most} J)");
    assert!(worst < 1e-7, "{worst} J from nowhere, of {most} J");
}

/// The same of a hull of many small faces that rolls over a lying cylinder.
fn created_on_cylinder(gains: &Gains, seed: u64) -> (f64, f64) {
    let mut rng = random::rng(seed);
    let mut u = |most: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-most..most)));
    let points: Vec<DVec3> = (0..120).map(|_| u(1.0).normalize() * 0.1).collect();
    let w = world(random::hull(&points), vec![lying_cylinder()]);
    let (turn, roll) = (DQuat::from_scaled_axis(u(2.0)), u(0.2));
    let path = |s: f64| Pose::new(mm(-4.0 + 8.0 * s, 8.0 * s, 97.0), DQuat::from_scaled_axis(roll * s) * turn);
    created_with(gains, &w, &path, 1500)
}

#[test]
fn a_round_part_whose_small_faces_lie_along_an_edge_keeps_both_their_ends_in_view() {
    for seed in [20, 22, 59] {
        let (worst, most) = created_on_cylinder(&Gains { proxy_speed: f64::INFINITY, ..Gains::default() }, seed);
        assert!(most > 1e-3, "{seed}: in contact ({most} J)");
        assert!(worst < 1e-7, "{seed}: {worst} J from nowhere, of {most} J");
    }
}

#[test]
fn a_corner_of_a_peg_comes_to_rest_in_an_obtuse_joint_of_a_hole() {
    for (sides, seed) in [(12, 1), (24, 2), (24, 20), (8, 30)] {
        let mut rng = random::rng(seed);
        let mut u = |most: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-most..most)));
        let (peg, plate) = (block(mm(6.0, 6.0, 30.0)), hole(sides, 10.0));
        let held = World {
            moving: plate.iter().cloned().map(Arc::new).collect(),
            fixed: vec![FixedPart { polyhedron: Arc::new(peg.clone()), obstacle: 0 }],
        };
        let (aside, drift, lean, sway) = (u(1.0), u(0.4e-3), u(0.25), u(0.1));
        let aside = DVec3::new(aside.x, aside.y, 0.0).normalize() * 8e-3;
        let path = |s: f64| {
            let place = aside + aside.cross(DVec3::Z) * 0.3 * s + drift * s;
            Pose::new(place, DQuat::from_scaled_axis(lean + sway * (3.0 * s).sin()))
        };
        let back = |s: f64| path(s).inverse();
        let of_peg = created(&world(peg, plate), &path, 800);
        let of_plate = created(&Arc::new(held), &back, 800);
        for (held, (worst, most)) in [("peg", of_peg), ("plate", of_plate)] {
            assert!(most > 1e-3, "{held}, {sides} sides: in contact ({most} J)");
            assert!(worst < 1e-7, "{held}, {sides} sides: {worst} J from nowhere, of {most} J");
        }
    }
}

#[test]
fn a_plate_led_along_steps_rests_where_one_stands_across_the_midst_of_anothers_edge() {
    // Steps side by side, each 3 mm lower than the last: the upright edge of one goes on past the bottom of its neighbour.
    let steps = |k: i32| {
        let (x, top) = (20.0 * f64::from(k), -3.0 * f64::from(k));
        cuboid(mm(x - 10.0, -40.0, top - 20.0), mm(x + 10.0, 40.0, top))
    };
    let w = world(block(mm(40.0, 30.0, 2.0)), (-2..=2).map(steps).collect());
    for seed in [9, 28] {
        let mut rng = random::rng(seed);
        let mut u = |most: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-most..most)));
        let (place, drift, lean, sway) = (u(10e-3), u(4e-3), u(0.3), u(0.1));
        let before = DVec3::new(place.x, -52e-3, -20e-3);
        let path = |s: f64| Pose::new(before + drift * s, DQuat::from_scaled_axis(lean + sway * (3.0 * s).sin()));
        let (worst, most) = created(&w, &path, 800);
        assert!(most > 1e-3, "{seed}: in contact ({most} J)");
        assert!(worst < 1e-7, "{seed}: {worst} J from nowhere, of {most} J");
    }
}

#[test]
fn a_peg_without_play_rocks_on_its_hole_and_gets_nothing_from_it() {
    // Its corners dip in by microns, where a wall's side and its top take turns to hold it.
    let (outer, inner) = (34.5, 4.5);
    let walls = vec![
        cuboid(mm(-30.0, inner, -30.0), mm(30.0, outer, 0.0)),
        cuboid(mm(-30.0, -outer, -30.0), mm(30.0, -inner, 0.0)),
        cuboid(mm(inner, -inner, -30.0), mm(outer, inner, 0.0)),
        cuboid(mm(-outer, -inner, -30.0), mm(-inner, inner, 0.0)),
    ];
    let w = world(block(mm(9.0, 9.0, 30.0)), walls);
    let path = |s: f64| {
        let i = 2000.0 * s;
        let turn = DQuat::from_scaled_axis(DVec3::new((i / 90.0).sin(), (i / 110.0).cos(), 0.0) * 0.01);
        Pose::new(mm(0.1 * (i / 50.0).sin(), 0.1 * (i / 70.0).cos(), 16.5 - 9.0 * (i / 1200.0).min(1.0)), turn)
    };
    let (worst, most) = created(&w, &path, 2000);
    assert!(most > 1e-2, "in contact ({most} J)");
    assert!(worst < 1e-7, "{worst} J from nowhere, of {most} J");
}

#[test]
fn friction_of_a_peg_that_leans_in_a_hole_only_takes() {
    let gains = Gains { friction_static: 0.4, friction_kinetic: 0.4, proxy_speed: f64::INFINITY, ..Gains::default() };
    for (sides, seed) in [(12, 1), (24, 2), (24, 20), (8, 30)] {
        let mut rng = random::rng(seed);
        let mut u = |most: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-most..most)));
        let w = world(block(mm(6.0, 6.0, 30.0)), hole(sides, 10.0));
        let (aside, drift, lean, sway) = (u(1.0), u(0.4e-3), u(0.25), u(0.1));
        let aside = DVec3::new(aside.x, aside.y, 0.0).normalize() * 8e-3;
        let path = |s: f64| {
            let place = aside + aside.cross(DVec3::Z) * 0.3 * s + drift * s;
            Pose::new(place, DQuat::from_scaled_axis(lean + sway * (3.0 * s).sin()))
        };
        let (worst, most) = created_with(&gains, &w, &path, 800);
        assert!(most > 1e-3, "{sides} sides: in contact ({most} J)");
        assert!(worst < 5e-8, "{sides} sides: {worst} J from nowhere, of {most} J");
    }
}

#[test]
fn friction_follows_a_round_part_from_edge_to_edge_and_only_takes() {
    let gains = Gains { friction_static: 0.4, friction_kinetic: 0.4, proxy_speed: f64::INFINITY, ..Gains::default() };
    for seed in [20, 22, 59] {
        let (worst, most) = created_on_cylinder(&gains, seed);
        assert!(most > 1e-3, "{seed}: in contact ({most} J)");
        assert!(worst < 2e-8, "{seed}: {worst} J from nowhere, of {most} J");
    }
}
