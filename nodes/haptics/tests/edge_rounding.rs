//! Off a sharp edge the ideal force vanishes at once; the proxy's speed softens that to a stated bound.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::DVec3;
use support::{block, cuboid, mm, pose, world};

/// Largest change of force in one tick, N, while the hand drags a block 3 mm deep over the plate's end.
fn worst_step(proxy_speed: f64) -> (f64, DVec3) {
    let w = world(block(mm(10.0, 10.0, 10.0)), vec![cuboid(mm(-50.0, -50.0, -20.0), mm(0.0, 50.0, 0.0))]);
    let gains = Gains { proxy_speed, ..Gains::default() };
    let mut r = Renderer::new(w);
    let mut last = r.render(&pose(-8.0, 0.0, 6.0, 0.0, 0.0, 0.0), &gains, 1e-3).wrench.force;
    let mut worst = 0.0_f64;
    let down = (0..400).map(|i| pose(-8.0, 0.0, 6.0 - 4.0 * f64::from(i) / 400.0, 0.0, 0.0, 0.0));
    let out = (0..2000).map(|i| pose(-8.0 + 0.01 * f64::from(i), 0.0, 2.0, 0.0, 0.0, 0.0));
    for p in down.chain(out) {
        let f = r.render(&p, &gains, 1e-3).wrench.force;
        worst = worst.max((f - last).length());
        last = f;
    }
    (worst, last)
}

#[test]
fn falling_off_an_edge_keeps_the_stated_bound() {
    let (sharp, end) = worst_step(f64::INFINITY);
    assert!(sharp > 2.9, "without rounding the 3 N fall at once: {sharp}");
    assert_eq!(end, DVec3::ZERO);
    for speed in [2.0, 0.5, 0.1] {
        let (worst, end) = worst_step(speed);
        // k (2 |dx| + v T): 1 N/mm, 0.01 mm a tick.
        let bound = 1000.0 * (2.0 * 1e-5 + speed * 1e-3);
        println!("{speed} m/s: {worst:.3} N in a tick, bound {bound:.3} N");
        assert!(worst <= bound + 1e-9, "{speed} m/s: {worst} over {bound}");
        assert!(end.length() < 1e-9, "it arrives: {end}");
    }
}

#[test]
fn changing_the_law_does_not_jump() {
    let w = world(block(mm(10.0, 10.0, 10.0)), vec![cuboid(mm(-50.0, -50.0, -20.0), mm(50.0, 50.0, 0.0))]);
    let mut r = Renderer::new(w);
    let at = pose(0.0, 0.0, 4.0, 0.02, 0.01, 0.0);
    let mut gains = Gains::default();
    r.render(&pose(0.0, 0.0, 8.0, 0.02, 0.01, 0.0), &gains, 1e-3);
    let mut last = r.render(&at, &gains, 1e-3).wrench;
    for law in [LawKind::Paper, LawKind::Blended, LawKind::Proxy, LawKind::Pstar, LawKind::Proxy] {
        gains.law = law;
        for tick in 0..100 {
            let out = r.render(&at, &gains, 1e-3).wrench;
            let change = out - last;
            // 50 ms for the whole difference, which is below the wrench itself: at most a fiftieth of it in a tick.
            assert!(
                change.force.length() <= 0.05 * last.force.length() + 1e-9,
                "{law:?} tick {tick}: {}",
                change.force
            );
            last = out;
        }
    }
}

#[test]
fn a_pose_that_is_none_changes_nothing() {
    let w = world(block(mm(10.0, 10.0, 10.0)), vec![cuboid(mm(-50.0, -50.0, -20.0), mm(50.0, 50.0, 0.0))]);
    for law in [LawKind::Paper, LawKind::Proxy] {
        let gains = Gains { law, ..Gains::default() };
        let mut r = Renderer::new(w.clone());
        r.render(&pose(0.0, 0.0, 8.0, 0.0, 0.0, 0.0), &gains, 1e-3);
        let before = r.render(&pose(0.0, 0.0, 4.0, 0.0, 0.0, 0.0), &gains, 1e-3).wrench;
        let mut broken = pose(0.0, 0.0, 4.0, 0.0, 0.0, 0.0);
        broken.translation.x = f64::NAN;
        assert!((r.render(&broken, &gains, 1e-3).wrench.force - before.force).length() < 1e-12);
        let after = r.render(&pose(0.0, 0.0, 4.0, 0.0, 0.0, 0.0), &gains, 1e-3).wrench;
        assert!((after.force - before.force).length() < 1e-12, "{law:?}: {} {}", after.force, before.force);
    }
}

#[test]
fn a_corner_on_its_way_over_a_rim_is_not_held_back() {
    // Of the edges at the corner one rises steeply outward: where that crosses the rim the corner stands lower and comes first.
    let w = world(block(mm(10.0, 10.0, 10.0)), vec![cuboid(mm(-50.0, -50.0, -20.0), mm(0.0, 50.0, 0.0))]);
    let gains = Gains { proxy_speed: f64::INFINITY, ..Gains::default() };
    for turn in [0.35, 0.5, 0.65, 0.8, 0.95] {
        let turned = |x: f64, z: f64| pose(x, 0.0, z, turn, 0.6, 0.2 * turn);
        let rotation = turned(0.0, 0.0).rotation;
        let corners = (0..8).map(|k| {
            rotation * mm(10.0 * f64::from(k & 1) - 5.0, 5.0 * f64::from(k & 2) - 5.0, 2.5 * f64::from(k & 4) - 5.0)
        });
        let lowest = corners.min_by(|p, q| p.z.total_cmp(&q.z)).expect("a block has corners") * 1e3;
        let mut r = Renderer::new(w.clone());
        let down = (0..400).map(|i| turned(-1.0 - lowest.x, 2.0 - 0.006 * f64::from(i) - lowest.z));
        let out = (0..400).map(|i| turned(-1.0 + 0.01 * f64::from(i) - lowest.x, -0.4 - lowest.z));
        let forces: Vec<DVec3> = down.chain(out).map(|p| r.render(&p, &gains, 1e-3).wrench.force).collect();
        assert!(forces.iter().any(|f| f.z > 0.39), "{turn} rad: in contact");
        let back = forces.iter().map(|f| -f.x).fold(0.0, f64::max);
        assert!(back < 1e-9, "{turn} rad: held back with {back} N");
    }
}
