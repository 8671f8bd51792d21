//! The proxy penetrates nothing: thin plates, wedges, corners, fast and wild motion. Depth by parry, an independent oracle.

mod support;

use cspace::World;
use haptics::{Gains, RenderLaw, Renderer};
use rand::{RngExt, SeedableRng};
use spatial::{DVec3, Pose};
use std::sync::Arc;
use support::{block, cuboid, mm, peg_in_hole, penetration, pose, tetrahedron, wedge, world};

/// Penetration (metres) allowed to the proxy by the oracle.
const ALLOWED: f64 = 1e-7;

/// Follows the poses; returns the worst penetration of the proxy and the last output's force.
fn follow(w: &Arc<World>, poses: impl Iterator<Item = Pose>, every: usize) -> (f64, DVec3, Pose) {
    let gains = Gains { proxy_speed: f64::INFINITY, ..Gains::default() };
    let mut r = Renderer::new(w.clone());
    let (mut worst, mut force, mut last) = (f64::NEG_INFINITY, DVec3::ZERO, Pose::IDENTITY);
    for (i, p) in poses.enumerate() {
        let out = r.render(&p, &gains, 1e-3);
        assert!(out.wrench.is_finite() && out.proxy.is_valid());
        if i % every == 0 {
            let depth = penetration(w, &out.proxy);
            if depth > worst {
                worst = depth;
                if depth > ALLOWED {
                    eprintln!("tick {i}: proxy {:?} penetrates {depth:e}, hand {p:?}", out.proxy);
                }
            }
        }
        (force, last) = (out.wrench.force, out.proxy);
    }
    (worst, force, last)
}

#[test]
fn half_millimetre_plate_holds_a_block_at_2_m_per_s() {
    let plate = cuboid(mm(-50.0, -50.0, -0.5), mm(50.0, 50.0, 0.0));
    for tilt in [0.0, 0.3, 0.7] {
        for body in [block(mm(10.0, 10.0, 10.0)), tetrahedron(12e-3), block(mm(0.5, 10.0, 10.0))] {
            let w = world(body, vec![plate.clone()]);
            // 2 mm a tick down to 50 mm below: 50 N at 1 N/mm.
            let poses = (0..60).map(|i| pose(0.0, 0.0, 20.0 - (2.0 * f64::from(i)).min(70.0), tilt, 0.5 * tilt, 0.1));
            let (worst, force, last) = follow(&w, poses, 1);
            assert!(worst < ALLOWED, "{worst:e}");
            assert!(force.z > 49.0, "pushed back with {force} N, proxy at {}", last.translation);
            assert!(last.translation.z > 0.0);
        }
    }
}

#[test]
fn wedges_and_blades_do_not_cut_through() {
    for half_angle in [0.05, 0.2, 0.5] {
        let w = world(block(mm(8.0, 8.0, 8.0)), vec![wedge(half_angle, 30e-3, 40e-3)]);
        // Sideways through the blade at 2 m/s, then down onto its edge.
        let side = (0..60).map(|i| pose(-20.0 + (2.0 * f64::from(i)).min(60.0), 0.0, -10.0, 0.1, 0.2, 0.3));
        let (worst, force, last) = follow(&w, side, 1);
        assert!(worst < ALLOWED, "{worst:e}");
        // The bluntest wedge lets the block ride up and over its edge; the blades hold it.
        if half_angle < 0.3 {
            assert!(force.x < -40.0 && last.translation.x < 0.0, "{force} at {}", last.translation);
        }
        let down = (0..60).map(|i| pose(0.0, 0.0, 20.0 - (2.0 * f64::from(i)).min(40.0), 0.2, 0.0, 0.3));
        assert!(follow(&w, down, 1).0 < ALLOWED);
    }
}

/// A smooth wild motion: sums of sines in all six directions, mm and rad, at up to about 2 m/s.
fn wild(seed: u64, ticks: usize, span: DVec3, turn: f64, center: DVec3) -> impl Iterator<Item = Pose> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut wave = || -> [(f64, f64, f64); 3] {
        std::array::from_fn(|_| (rng.random_range(1.0..12.0), rng.random_range(0.0..6.3), rng.random_range(0.2..1.0)))
    };
    let waves: [[(f64, f64, f64); 3]; 6] = std::array::from_fn(|_| wave());
    (0..ticks).map(move |i| {
        let t = i as f64 * 1e-3;
        let v: [f64; 6] =
            std::array::from_fn(|k| waves[k].iter().map(|(w, p, a)| a * (w * t + p).sin()).sum::<f64>() / 2.0);
        let c = center * 1e3;
        pose(c.x + span.x * v[0], c.y + span.y * v[1], c.z + span.z * v[2], turn * v[3], turn * v[4], turn * v[5])
    })
}

#[test]
fn wild_motion_never_penetrates() {
    let plate = cuboid(mm(-30.0, -30.0, -0.5), mm(30.0, 30.0, 0.0));
    let corner = vec![
        cuboid(mm(-40.0, -40.0, -20.0), mm(40.0, 40.0, 0.0)),
        cuboid(mm(15.0, -40.0, -20.0), mm(40.0, 40.0, 40.0)),
        wedge(0.15, 20e-3, 30e-3),
    ];
    let worlds = [
        ("box, thin plate", world(block(mm(12.0, 9.0, 7.0)), vec![plate.clone()])),
        ("tetrahedron, thin plate", world(tetrahedron(14e-3), vec![plate])),
        ("box, corner and blade", world(block(mm(12.0, 9.0, 7.0)), corner)),
        ("tetrahedron, box", world(tetrahedron(20e-3), vec![block(mm(20.0, 20.0, 20.0))])),
        ("peg in hole", peg_in_hole()),
    ];
    for (name, w) in &worlds {
        for seed in 0..4 {
            let center = if *name == "peg in hole" { mm(0.0, 0.0, 18.0) } else { mm(0.0, 0.0, 5.0) };
            let turn = if seed % 2 == 0 { 0.3 } else { 1.5 };
            let (worst, ..) = follow(w, wild(seed, 4000, DVec3::new(25.0, 25.0, 20.0), turn, center), 3);
            println!("{name}, seed {seed}: proxy penetrates at most {worst:.1e} m");
            assert!(worst < ALLOWED, "{name} seed {seed}: {worst:e}");
        }
    }
}
