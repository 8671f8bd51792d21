//! Several obstacles and several pieces of one: no doubled stiffness, no felt seams.

mod support;

use cspace::{FixedPart, Polyhedron, World};
use glam::DVec2;
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use std::sync::Arc;
use support::{block, cuboid, hole, mm, peg_in_hole, pose, world};

const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

fn gains(law: LawKind) -> Gains {
    Gains { law, ..Gains::default() }
}

#[test]
fn corner_of_floor_and_wall_pulls_with_the_root_of_two() {
    let w = world(
        block(mm(10.0, 10.0, 10.0)),
        vec![
            cuboid(mm(-50.0, -50.0, -20.0), mm(50.0, 50.0, 0.0)),
            cuboid(mm(20.0, -50.0, -20.0), mm(50.0, 50.0, 50.0)),
        ],
    );
    for law in LAWS {
        let mut r = Renderer::new(w.clone());
        let mut out = r.render(&pose(10.0, 0.0, 10.0, 0.0, 0.0, 0.0), &gains(law), 1e-3);
        assert_eq!(out.wrench.force, DVec3::ZERO);
        for i in 1..=100 {
            let s = f64::from(i) / 100.0;
            out = r.render(&pose(10.0 + 6.0 * s, 0.0, 10.0 - 6.0 * s, 0.0, 0.0, 0.0), &gains(law), 1e-3);
        }
        // One millimetre into each at 1 N/mm.
        assert!((out.wrench.force - DVec3::new(-1.0, 0.0, 1.0)).length() < 1e-9, "{law:?} {}", out.wrench.force);
        assert!((out.wrench.force.length() - 2f64.sqrt()).abs() < 1e-9);
        assert!((out.proxy.translation - mm(15.0, 0.0, 5.0)).length() < 1e-9, "{law:?}");
    }
}

#[test]
fn peg_on_two_walls_and_the_bottom_feels_each_once() {
    for law in LAWS {
        let mut r = Renderer::new(peg_in_hole());
        let mut out = r.render(&pose(0.0, 0.0, 21.0, 0.0, 0.0, 0.0), &gains(law), 1e-3);
        for i in 1..=400 {
            let s = f64::from(i) / 400.0;
            // 0.5 mm into the walls, 1 mm into the bottom.
            let p = pose((0.125 + 0.5) * s, (0.105 + 0.5) * s, 21.0 - 32.0 * s, 0.0, 0.0, 0.0);
            out = r.render(&p, &gains(law), 1e-3);
        }
        let expected = DVec3::new(-0.5, -0.5, 1.0);
        assert!((out.wrench.force - expected).length() < 1e-9, "{law:?} {}", out.wrench.force);
    }
}

/// At the far rim the top, which carries, and the side of the piece there both pass through the place of contact.
/// A wall through the y axis that leans back, so that `angle` (radians) is free between it and the floor, which covers its foot.
fn leaning_wall(angle: f64) -> Polyhedron {
    let up = DVec3::new(angle.cos(), 0.0, angle.sin());
    let behind = DVec3::new(-up.z, 0.0, up.x);
    let corner = |i: usize| {
        let deep = if i & 1 == 0 { 0.0 } else { 0.02 };
        let along = if i & 2 == 0 { -0.02 } else { 0.06 };
        up * along + behind * deep + DVec3::Y * if i & 4 == 0 { -0.05 } else { 0.05 }
    };
    let corners: Vec<DVec3> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Polyhedron::from_faces(&corners, &faces.map(|f| f.to_vec())).expect("a slab is a polyhedron")
}

/// In an obtuse corner both the contact and A's middle stand over the part of the wall that the floor covers.
#[test]
fn obtuse_corners_push_by_the_nearest_free_place() {
    for degrees in [95.0f64, 110.0, 120.0, 135.0, 150.0, 165.0] {
        let angle = degrees.to_radians();
        let floor = cuboid(mm(-60.0, -50.0, -20.0), mm(80.0, 50.0, 0.0));
        let w = world(block(mm(10.0, 10.0, 10.0)), vec![floor, leaning_wall(angle)]);
        for law in LAWS {
            let mut r = Renderer::new(w.clone());
            for i in 0..=200 {
                // From 5 mm over the corner to where both planes are entered by 1 mm.
                let depth = 6e-3 * f64::from(i) / 200.0 - 5e-3;
                let out_of_both = DVec3::new((1.0 + angle.cos()) / angle.sin(), 0.0, 1.0);
                let hand = Pose::new(mm(5.0, 0.0, 5.0) - out_of_both * depth, DQuat::IDENTITY);
                let out = r.render(&hand, &gains(law), 1e-3);
                let expected = out_of_both * depth.max(0.0) * 1e3;
                assert!(
                    (out.wrench.force - expected).length() < 1e-6,
                    "{degrees} {law:?} {depth}: {}, not {expected}",
                    out.wrench.force
                );
                assert!((out.depth - depth.max(0.0)).abs() < 1e-9, "{degrees} {law:?} {depth}: {}", out.depth);
            }
        }
    }
}

/// At the far rim the top, which carries, and the side of the piece there meet at the proxy, equal but for rounding.
#[test]
fn a_block_that_slides_flat_over_a_hole_does_not_catch_on_its_rim() {
    let w = world(block(mm(16.0, 40.0, 10.0)), hole());
    for law in LAWS {
        for yaw in [0.0, 0.1, 0.2, 0.3, 0.5, 0.8] {
            let mut r = Renderer::new(w.clone());
            for i in 0..1500 {
                let hand = over_the_hole(f64::from(i) / 1500.0, yaw);
                let out = r.render(&hand, &gains(law), 1e-3);
                let [x, y, z] = out.wrench.force.to_array();
                let lift = (5.0 - 1e3 * hand.translation.z).max(0.0);
                let place = format!("{law:?}, yaw {yaw}, tick {i}: {} {}", out.wrench.force, out.wrench.torque);
                assert!(x.hypot(y) < 1e-6 && (z - lift).abs() < 1e-6, "{place}");
                // The block's middle stands over the plate or between its borders: nothing tips it.
                assert!(out.wrench.torque.length() < 1e-8, "{place}");
            }
        }
    }
}

/// The rim of the far wall stands a little above the plate: no more than this step is to be climbed.
#[test]
fn a_block_that_slides_flat_climbs_a_small_step_at_the_rim() {
    let step = 1e-6;
    let mut pieces = hole();
    pieces[2] = cuboid(mm(-16.25 / 2.0, 10.21 / 2.0, -40.0), mm(16.25 / 2.0, 30.0, 1e3 * step));
    let w = world(block(mm(16.0, 40.0, 10.0)), pieces);
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended] {
        for yaw in [0.0, 0.3] {
            let mut r = Renderer::new(w.clone());
            let mut climbed = 0;
            for i in 0..1500 {
                let hand = over_the_hole(f64::from(i) / 1500.0, yaw);
                let out = r.render(&hand, &gains(law), 1e-3);
                let way = out.proxy.translation - hand.translation;
                let lift = 5e-3 - hand.translation.z;
                // The far wall is penetrated by its side first, less than the others by their tops.
                let over = hand.translation.y + 20e-3 - 0.5 * 10.21e-3;
                if yaw == 0.0 && lift > 0.0 && over > 0.0 && over < lift {
                    assert!((out.depth - lift).abs() < 1e-12, "{law:?}, tick {i}: {} for {lift}", out.depth);
                }
                climbed += i32::from(lift > 0.0 && (way.z - lift - step).abs() < 1e-12);
                assert!(way.length() < lift.max(0.0) + step + 1e-12, "{law:?}, yaw {yaw}, tick {i}: {way}");
            }
            assert!(climbed > 400, "{law:?}, yaw {yaw}: {climbed}");
        }
    }
}

/// A block 10 mm high that comes down by 1 mm into the plate and slides over the hole, at `s` from 0 to 1.
fn over_the_hole(s: f64, yaw: f64) -> Pose {
    let z = 4.0 + 2.0 * (1.0 - 10.0 * s).max(0.0);
    pose(-2.0, -20.0 + 30.0 * (s - 0.1).max(0.0), z, 0.0, 0.0, yaw)
}

/// The floor cut at random into `n` tiles that abut or overlap, with joints that end at other joints.
fn tiles(seed: u64, n: usize) -> Vec<Polyhedron> {
    let mut rng = support::random::rng(seed);
    let mut tiles = vec![[DVec2::splat(-40.0), DVec2::splat(40.0)]];
    while tiles.len() < n {
        let [low, high] = tiles.swap_remove(rng.random_range(0..tiles.len()));
        let at = low.lerp(high, rng.random_range(0.3..0.7));
        let across = if rng.random() { DVec2::new(at.x, high.y) } else { DVec2::new(high.x, at.y) };
        tiles.push([low, across]);
        tiles.push([if across.x == at.x { DVec2::new(at.x, low.y) } else { DVec2::new(low.x, at.y) }, high]);
    }
    let mut grow = || if rng.random() { rng.random_range(0.0..6.0) } else { 0.0 };
    tiles
        .into_iter()
        .map(|[low, high]| {
            let low = (low - DVec2::new(grow(), grow())).max(DVec2::splat(-40.0));
            let high = (high + DVec2::new(grow(), grow())).min(DVec2::splat(40.0));
            cuboid(mm(low.x, low.y, -20.0), mm(high.x, high.y, 0.0))
        })
        .collect()
}

/// How the box rocks, rad, after `s` seconds.
fn tilt(s: f64) -> f64 {
    0.05 * (7.0 * s).sin()
}

/// A box pushed into and dragged and rocked over a floor, by every law.
fn over_the_floor(w: &Arc<World>, law: LawKind, flat: bool) -> Vec<spatial::Wrench> {
    let mut r = Renderer::new(w.clone());
    r.render(&pose(-12.0, 1.0, 8.0, 0.0, 0.0, 0.0), &gains(law), 1e-3);
    (0..3000)
        .map(|i| {
            let s = f64::from(i) * 1e-3;
            let tilt = if flat { 0.0 } else { tilt(s) };
            let p = pose(-12.0 + 8.0 * s, 1.0 + (3.0 * s).sin(), 4.0 + (5.0 * s).cos(), tilt, 0.7 * tilt, 0.3 * s);
            r.render(&p, &gains(law), 1e-3).wrench
        })
        .collect()
}

#[test]
fn floor_cut_into_pieces_feels_like_the_whole_floor() {
    floor_cut_into_pieces(&|| block(mm(10.0, 8.0, 9.0)), &LAWS);
}

/// Its corners are blunt: they weigh less than those of a joint would.
#[test]
fn floor_cut_into_pieces_feels_like_the_whole_floor_to_a_round_tool() {
    floor_cut_into_pieces(&|| support::random::prism(40, 8e-3, 9e-3), &[LawKind::Blended]);
}

fn floor_cut_into_pieces(tool: &dyn Fn() -> Polyhedron, laws: &[LawKind]) {
    let piece = |from: f64, to: f64| cuboid(mm(from, -40.0, -20.0), mm(to, 40.0, 0.0));
    let whole = world(tool(), vec![piece(-40.0, 40.0)]);
    let mut cuts = vec![
        world(tool(), vec![piece(-40.0, 0.0), piece(0.0, 40.0)]),
        world(tool(), vec![piece(-40.0, 3.0), piece(-2.0, 40.0)]),
        world(tool(), vec![piece(-40.0, -4.0), piece(-5.0, 2.0), piece(2.0, 40.0)]),
    ];
    cuts.extend((1..=8).map(|seed| world(tool(), tiles(seed, 3 + seed as usize))));
    for law in laws.iter().copied() {
        for flat in [true, false] {
            let expected = over_the_floor(&whole, law, flat);
            let peak = expected.iter().map(|w| w.force.length()).fold(0.0, f64::max);
            assert!(peak > 1.0);
            for (k, cut) in cuts.iter().enumerate() {
                let found = over_the_floor(cut, law, flat);
                for (i, (f, e)) in found.iter().zip(&expected).enumerate() {
                    let df = (f.force - e.force).length();
                    assert!(df < 1e-6, "{law:?} flat {flat} cut {k} tick {i}: force {} for {}", f.force, e.force);
                    // The torque of `pstar` jumps where the box lies down flat; of that very tick the pieces may
                    // see the one side or the other.
                    let lies_down = !flat && tilt(f64::from(i as u32) * 1e-3).abs() < 1e-5;
                    if law == LawKind::Proxy || law == LawKind::Blended || law == LawKind::Pstar && !lies_down {
                        let dt = (f.torque - e.torque).length();
                        assert!(dt < 1e-6, "{law:?} flat {flat} cut {k} tick {i}: {} for {}", f.torque, e.torque);
                    }
                }
            }
        }
    }
}

/// The tip alone touches, and the nearest planes of all pairs are seams: of the tip's part the floor's joint, of the other part
/// the floor under a corner that only the cut made. The tip's way out frees both.
#[test]
fn the_tip_of_a_cut_part_over_a_joint_pushes_straight_up() {
    let hull = |points: &[[f64; 3]]| {
        Arc::new(support::random::hull(&points.iter().map(|p| mm(p[0], p[1], p[2])).collect::<Vec<_>>()))
    };
    // A tip at the origin below a slab that lies to its left, cut 0.75 mm to the left of the tip.
    let right = |x: f64| [[x, 10.0 * x / 20.0, -0.5 * x], [x, -10.0 * x / 20.0, -0.5 * x]];
    let (low, high) = (right(-0.75), [[-0.75, 7.5, 7.5], [-0.75, -7.5, 7.5]]);
    let left = [
        low[0],
        low[1],
        high[0],
        high[1],
        [-20.0, 10.0, 10.0],
        [-20.0, -10.0, 10.0],
        [-1.0, 10.0, 10.0],
        [-1.0, -10.0, 10.0],
    ];
    let tip = [low[0], low[1], high[0], high[1], [0.0, 0.0, 0.0]];
    let floor = |x: [f64; 2]| Arc::new(cuboid(mm(x[0], -60.0, -20.0), mm(x[1], 60.0, 0.0)));
    let fixed = [[-60.0, 0.0], [0.0, 60.0]].map(|x| FixedPart { polyhedron: floor(x), obstacle: 0 });
    let w = Arc::new(World { moving: vec![hull(&left), hull(&tip)], fixed: fixed.to_vec() });
    for law in LAWS {
        let mut r = Renderer::new(w.clone());
        for i in 0..=100 {
            let depth = 0.8 * f64::from(i) / 100.0;
            let force = r.render(&pose(0.71, 0.3, -depth, 0.0, 0.0, 0.0), &gains(law), 1e-3).wrench.force;
            let off = if law == LawKind::Proxy { force.with_z(0.0) } else { force - DVec3::Z * depth };
            assert!(off.length() < 1e-6 && force.z <= depth + 1e-6, "{law:?}, {depth} mm: {force}");
        }
    }
}

/// Ticks 105 to 107 once gave five times the force: the nearest plane of the part's rear half to the floor's right half is a
/// joint there, and the way out runs along it.
/// The part's edge meets the rim of the wall in a place where the hand, deep in another wall, is not: of the pieces that the rim is cut
/// into, the contact is that of the one which is touched.
#[test]
fn an_edge_that_meets_the_rim_of_a_cut_wall_where_the_hand_is_not_touches_the_piece_there() {
    let walls = |cut: bool| {
        let mut fixed = vec![
            cuboid(mm(-30.0, 5.0, -9.0), mm(8.0, 25.0, 0.0)),
            cuboid(mm(-30.0, -25.0, -14.0), mm(30.0, 25.0, -9.0)),
        ];
        if cut {
            fixed.insert(0, cuboid(mm(8.0, -25.0, -9.0), mm(30.0, 0.0, 0.0)));
            fixed.insert(1, cuboid(mm(8.0, 0.0, -9.0), mm(30.0, 25.0, 0.0)));
        } else {
            fixed.insert(0, cuboid(mm(8.0, -25.0, -9.0), mm(30.0, 25.0, 0.0)));
        }
        world(block(mm(16.0, 10.0, 24.0)), fixed)
    };
    for law in [LawKind::Paper, LawKind::Pstar] {
        let [whole, cut] = [false, true].map(|cut| {
            let mut r = Renderer::new(walls(cut));
            let (from, to) = (DVec3::new(2.68e-5, 3.168e-4, 2.9628e-3), DVec3::new(4.46e-5, 3.056e-4, 2.9619e-3));
            let (tilted, leaning) = (DVec3::new(9.42e-3, 1.93e-2, -3.54e-2), DVec3::new(8.4e-3, 1.795e-2, -3.635e-2));
            let mut render =
                |at: DVec3, turn: DVec3| r.render(&Pose::new(at, DQuat::from_scaled_axis(turn)), &gains(law), 1e-3);
            for i in 0..400 {
                let s = f64::from(i) / 400.0;
                render(from + DVec3::Z * (0.02 * (1.0 - s)), tilted * s.powi(8));
            }
            let on = |i: i32| f64::from(i) / 40.0;
            (0..=40).map(|i| render(from.lerp(to, on(i)), tilted.lerp(leaning, on(i)))).collect::<Vec<_>>()
        });
        let mut touched = 0;
        for (w, c) in whole.iter().zip(&cut) {
            assert!((w.wrench.force - c.wrench.force).length() < 1e-9, "{law:?} {:?} {:?}", w.wrench, c.wrench);
            assert!((w.wrench.torque - c.wrench.torque).length() < 1e-9, "{law:?} {:?} {:?}", w.wrench, c.wrench);
            touched += usize::from(c.formation.points().iter().any(|p| p.contact.type_letter() == 'C'));
        }
        assert!(touched > 10, "{touched}");
    }
}

#[test]
fn cut_box_on_a_cut_floor_beside_a_wall_feels_like_the_whole_ones() {
    let piece =
        |x: [f64; 2], low: DVec3, high: DVec3| Arc::new(cuboid(mm(x[0], low.y, low.z), mm(x[1], high.y, high.z)));
    let part = |x: [f64; 2]| piece(x, DVec3::new(0.0, -15.0, -10.0), DVec3::new(0.0, 15.0, 10.0));
    let floor = |x: [f64; 2]| piece(x, DVec3::new(0.0, -100.0, -20.0), DVec3::new(0.0, 100.0, 0.0));
    let wall = piece([-120.0, -50.0], DVec3::new(0.0, -100.0, -20.0), DVec3::new(0.0, 100.0, 100.0));
    let build = |moving: Vec<Arc<Polyhedron>>, fixed: Vec<Arc<Polyhedron>>| {
        let fixed =
            fixed.into_iter().zip(0..).map(|(polyhedron, obstacle)| FixedPart { polyhedron, obstacle }).collect();
        Arc::new(World { moving, fixed })
    };
    let whole = build(vec![part([-20.0, 20.0])], vec![floor([-100.0, 100.0]), wall.clone()]);
    let cut =
        build(vec![part([-20.0, 4.0]), part([4.0, 20.0])], vec![floor([-100.0, 13.0]), floor([-20.0, 100.0]), wall]);
    let corners: Vec<DVec3> = whole.moving[0].vertices().to_vec();
    let pose_at = |tick: u32| {
        let s = f64::from(tick) / 2999.0;
        let turn = |axis: DVec3, angle: f64| DQuat::from_axis_angle(axis.normalize(), angle);
        let rotation = turn(DVec3::new(1.0, 0.3, 0.2), 1.5 * s) * turn(DVec3::new(0.1, 1.0, 0.4), s);
        let lowest = corners.iter().map(|c| (rotation * *c).z).fold(f64::INFINITY, f64::min);
        let leftmost = corners.iter().map(|c| (rotation * *c).x).fold(f64::INFINITY, f64::min);
        let x = (-0.03 + 0.02 * (9.0 * s).sin()).max(-0.05 - leftmost - 0.0007);
        let y = 0.05 * (7.0 * s + 1.0).sin();
        let z = -lowest - 0.0005 * (1.0 + (30.0 * s).sin());
        Pose::new(DVec3::new(x, y, z), rotation)
    };
    for law in LAWS {
        let (mut a, mut b) = (Renderer::new(whole.clone()), Renderer::new(cut.clone()));
        for tick in 0..400 {
            let expected = a.render(&pose_at(tick), &gains(law), 1e-3).wrench;
            let found = b.render(&pose_at(tick), &gains(law), 1e-3).wrench;
            let df = (found.force - expected.force).length();
            assert!(df < 1e-6, "{law:?} tick {tick}: force {} for {}", found.force, expected.force);
            if law != LawKind::Paper {
                let dt = (found.torque - expected.torque).length();
                assert!(dt < 1e-6, "{law:?} tick {tick}: torque {} for {}", found.torque, expected.torque);
            }
        }
    }
}
