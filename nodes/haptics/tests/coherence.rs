//! What a tick takes over from the last one, or does not look at for being out of reach, changes nothing of its answer.

mod support;

use cspace::World;
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::Pose;
use std::sync::Arc;
use support::{block, cuboid, mm, peg_in_hole, pose, world};

/// A hand that wavers in the hole, deep in its bottom and walls and out of them again: slowly at first, millimetres in a tick at last.
fn wavering(i: u32, n: u32) -> Pose {
    let s = f64::from(i) / f64::from(n);
    let phase = 20.0 * s + 300.0 * s.powi(6);
    let (x, y, z) = (0.3 * (1.7 * phase).sin(), 0.25 * (2.3 * phase).cos(), 0.6 * (1.1 * phase).sin());
    let turn = 6e-3;
    pose(x, y, -10.1 + z, turn * (0.7 * phase).sin(), turn * (1.3 * phase).cos(), turn * (0.9 * phase).sin())
}

/// The way into the hole.
fn entering() -> impl Iterator<Item = Pose> {
    (0..400).map(|i| pose(0.0, 0.0, 25.0 - 0.0875 * f64::from(i), 0.0, 0.0, 0.0))
}

/// The largest force of a proxy on this path, N, how much it differs from that of a proxy which looks at everything around it in
/// each tick, and the most contacts at a time.
fn compare(world: &Arc<World>, path: impl Iterator<Item = Pose>) -> (f64, f64, usize) {
    let near = Gains { law: LawKind::Proxy, ..Gains::default() };
    // With friction, be it ever so little, the proxy looks around as far as it can.
    let far = Gains { friction_static: 1e-15, friction_kinetic: 1e-15, ..near };
    let (mut r, mut s) = (Renderer::new(world.clone()), Renderer::new(world.clone()));
    let (mut most, mut worst, mut contacts) = (0.0_f64, 0.0_f64, 0);
    for hip in path {
        let (out, all) = (r.render(&hip, &near, 1e-3), s.render(&hip, &far, 1e-3));
        most = most.max(all.wrench.force.length());
        worst = worst.max((out.wrench.force - all.wrench.force).length());
        contacts = contacts.max(all.formation.points().len());
    }
    (most, worst, contacts)
}

#[test]
fn contacts_out_of_a_ticks_reach_change_nothing() {
    let n = 6000;
    let (most, worst, contacts) = compare(&peg_in_hole(), entering().chain((0..n).map(|i| wavering(i, n))));
    assert!(contacts > 3 && most > 0.3, "{contacts} contacts, {most} N");
    assert!(worst < 1e-8 * most, "{worst} N of {most} N");
}

#[test]
fn a_proxy_that_falls_while_the_hand_hardly_moves_lands_on_what_is_below() {
    let stairs =
        vec![cuboid(mm(-40.0, -40.0, -20.0), mm(0.0, 40.0, 0.0)), cuboid(mm(0.0, -40.0, -20.0), mm(40.0, 40.0, -1.5))];
    let world = world(block(mm(10.0, 8.0, 6.0)), stairs);
    let down = (0..100).map(|i| pose(-8.0, 0.0, 3.5 - 0.055 * f64::from(i), 0.0, 0.0, 0.0));
    let across = (0..7000).map(|i| pose(-8.0 + 2e-3 * f64::from(i), 0.0, -2.0, 0.0, 0.01, 0.0));
    let (most, worst, _) = compare(&world, down.chain(across));
    assert!(most > 4.0, "{most} N");
    assert!(worst < 1e-8 * most, "{worst} N of {most} N");
}

#[test]
fn the_depth_held_is_the_depth_found() {
    let gains = Gains { law: LawKind::Proxy, ..Gains::default() };
    let mut held = Renderer::new(peg_in_hole());
    let mut found = Renderer::new(peg_in_hole());
    let n = 6000;
    let (mut inside, mut differ) = (0, 0);
    for hip in entering().chain((0..n).map(|i| wavering(i, n))) {
        let depth = held.render(&hip, &gains, 1e-3).depth;
        // Reset, nothing is held.
        found.reset();
        let anew = found.render(&hip, &gains, 1e-3).depth;
        inside += u32::from(anew > 1e-5);
        differ += u32::from((depth - anew).abs() > 1e-12);
    }
    assert!(inside > 1000, "{inside} ticks inside");
    assert_eq!(differ, 0, "of {inside} ticks inside");
}
