//! A peg turned farther than its hole has room for: no touching configuration is near, and still the depth laws stay sane.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::{DQuat, DVec3, Pose};
use support::{block, cuboid, mm, peg_in_hole, pose, world};

const LAWS: [LawKind; 3] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended];
/// The peg's and the hole's half sides, mm.
const PEG: [f64; 2] = [8.0, 5.0];
const HOLE: [f64; 2] = [16.25 / 2.0, 10.21 / 2.0];

fn gains(law: LawKind) -> Gains {
    Gains { law, ..Gains::default() }
}

/// Each of the four walls pushes back the corner that is in it, by its depth.
#[test]
fn turned_about_the_hole_s_axis_it_feels_the_couple_of_the_walls() {
    for law in LAWS {
        let mut r = Renderer::new(peg_in_hole());
        for i in 0..=2000 {
            let yaw = 0.04 * f64::from(i) / 2000.0;
            let out = r.render(&pose(0.0, 0.0, 5.0, 0.0, 0.0, yaw), &gains(law), 1e-3);
            let (s, c) = yaw.sin_cos();
            let depths = [PEG[0] * c + PEG[1] * s - HOLE[0], PEG[0] * s + PEG[1] * c - HOLE[1]].map(|d| d.max(0.0));
            let levers = [PEG[1] * c - PEG[0] * s, PEG[0] * c - PEG[1] * s];
            // Millimetres by 1 N/mm.
            let expected = -2.0 * (depths[0] * levers[0] + depths[1] * levers[1]) * 1e-3;
            let place = format!("{law:?}, yaw {yaw}: {} {}", out.wrench.force, out.wrench.torque);
            assert!(out.wrench.force.length() < 1e-9, "{place}");
            if law == LawKind::Blended {
                // Nearly as deep, the other corners of the same face share the force.
                assert!((expected..1e-9).contains(&out.wrench.torque.z), "{place} for {expected}");
            } else {
                assert!((out.wrench.torque - DVec3::Z * expected).length() < 1e-8, "{place} for {expected}");
            }
        }
    }
}

#[test]
fn turned_and_tilted_the_force_follows_the_hand() {
    for law in LAWS {
        for z in [-10.5, 5.0, 18.5] {
            let mut r = Renderer::new(peg_in_hole());
            let at = |i: u32, z: f64| {
                let (t, turn) = (f64::from(i), 1e-3 + 2e-5 * f64::from(i));
                pose(0.05 * (0.05 * t).sin(), 0.03 * (0.03 * t).cos(), z, 0.0, 0.3 * turn, turn)
            };
            for i in 0..1000 {
                r.render(&at(0, 21.0 + (z - 21.0) * f64::from(i) / 1000.0), &gains(law), 1e-3);
            }
            let mut last = None;
            for i in 0..3000 {
                let hand = at(i, z);
                let out = r.render(&hand, &gains(law), 1e-3);
                let way = out.proxy.translation - hand.translation;
                let place = format!("{law:?}, {z} mm, tick {i}: {} {}", out.wrench.force, out.wrench.torque);
                assert!(way.length() <= 3.0 * out.depth + 1e-12, "{place}");
                // No point of the peg moves farther than 4 micrometres in a tick.
                if let Some(last) = last.replace(out.wrench) {
                    assert!((out.wrench.force - last.force).length() < 0.01, "{place} after {}", last.force);
                }
            }
        }
    }
}

#[test]
fn turned_it_cannot_be_pushed_in_from_above() {
    for law in LAWS {
        let mut r = Renderer::new(peg_in_hole());
        for i in 0..2000 {
            let z = 20.5 - 0.01 * f64::from(i);
            let force = r.render(&pose(0.02, -0.01, z, 0.0, 0.0, 0.05), &gains(law), 1e-3).wrench.force;
            let lift = (20.0 - z).max(0.0);
            assert!((force - DVec3::Z * lift).length() < 1e-6, "{law:?}, {z} mm: {force}");
        }
    }
}

/// A hole without play, and a peg that is turned by up to 10 mrad in it: wherever the way out leads, the force is shown where it takes
/// place, and every wall that the peg is in is told.
#[test]
fn turned_in_a_hole_without_play_it_feels_every_wall_and_no_lever_longer_than_itself() {
    let half = 4.5;
    let walls = vec![
        cuboid(mm(-30.0, half, -30.0), mm(30.0, 30.0, 0.0)),
        cuboid(mm(-30.0, -30.0, -30.0), mm(30.0, -half, 0.0)),
        cuboid(mm(half, -half, -30.0), mm(30.0, half, 0.0)),
        cuboid(mm(-30.0, -half, -30.0), mm(-half, half, 0.0)),
    ];
    let w = world(block(mm(2.0 * half, 2.0 * half, 30.0)), walls);
    for law in LAWS {
        let mut r = Renderer::new(w.clone());
        for i in 0..1200 {
            let t = f64::from(i);
            let turn = DVec3::new((t / 90.0).sin(), (t / 110.0).cos(), 0.0) * 0.01;
            let at = mm(0.1 * (t / 50.0).sin(), 0.1 * (t / 70.0).cos(), 16.5 - 9.0 * t / 1200.0);
            let hand = Pose::new(at, DQuat::from_scaled_axis(turn));
            let out = r.render(&hand, &gains(law), 1e-3);
            let place = format!("{law:?}, tick {i}: {} {} {}", out.wrench.force, out.wrench.torque, out.depth);
            let pushes = out.wrench.force.length() + 4.0 * out.depth * gains(law).stiffness;
            assert!(out.wrench.torque.length() <= 17e-3 * pushes, "{place}");
            // How far the part of the peg that is in the hole reaches into the walls.
            let corners = w.moving[0].vertices().iter().map(|v| hand.transform_point(*v)).filter(|v| v.z < -1e-3);
            let aside = corners.map(|v| v.x.abs().max(v.y.abs()) - half * 1e-3).fold(0.0, f64::max);
            assert!(out.depth >= aside - 1e-9, "{place}, but {aside}");
        }
    }
}
