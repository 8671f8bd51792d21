//! The proxy of parts so long that contacts turn them more stiffly than the coupling does.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use support::random::{prism, rng};
use support::{block, cuboid, mm, random, world};

#[test]
fn a_long_part_pressed_on_a_tip_comes_to_rest() {
    let tip = [mm(0.0, 0.0, 0.0), mm(40.0, 40.0, -200.0), mm(-40.0, 40.0, -200.0), mm(0.0, -50.0, -200.0)];
    let gains = Gains { law: LawKind::Proxy, ..Gains::default() };
    for seed in 0..20 {
        let mut rng = random::rng(seed);
        let mut u = |low: f64, high: f64| rng.random_range(low..high);
        let w = world(block(DVec3::new(0.3, 0.3, 1.4)), vec![random::hull(&tip)]);
        let turn = DQuat::from_scaled_axis(DVec3::new(u(-0.6, 0.6), u(-0.6, 0.6), u(-3.0, 3.0)));
        // The tip meets the lower face about under the middle.
        let at = turn * DVec3::new(u(-0.02, 0.02), u(-0.02, 0.02), -0.7);
        let press = u(2e-3, 6e-3);
        let mut r = Renderer::new(w);
        let mut last = None;
        for i in 0..600 {
            let deep = press * (f64::from(i) / 300.0).min(1.0);
            let out = r.render(&Pose::new(-at - DVec3::Z * deep, turn), &gains, 1e-3);
            if let Some(before) = last.replace(out.wrench)
                && i > 400
            {
                let change = (out.wrench.torque - before.torque).length();
                assert!(change < 1e-6, "seed {seed}, tick {i}: {change} N.m of {}", out.wrench.torque.length());
            }
        }
        assert!(last.is_some_and(|l| l.force.length() > 0.5), "seed {seed}: in contact");
    }
}

/// A large part pressed deep against a long edge, and held there: whatever the rounds of a tick lead to, the proxy comes to rest where
/// nothing pulls it along the edge.
#[test]
fn a_large_part_held_against_an_edge_comes_to_rest() {
    let step = |x: [f64; 2], top: f64| cuboid(DVec3::new(x[0], -0.6, -0.4), DVec3::new(x[1], 0.6, top));
    let gains = Gains::default();
    let mut held = 0;
    for seed in 0..120 {
        let mut rng = rng(seed);
        let mut any = || DVec3::from_array([0; 3].map(|_| rng.random_range(-1.0..1.0)));
        let part = prism(5 + (seed % 7) as usize, 0.3, 0.25);
        let rotation = DQuat::from_scaled_axis(3.0 * any());
        let lowest = part.vertices().iter().map(|v| (rotation * *v).z).fold(f64::INFINITY, f64::min);
        let mut r = Renderer::new(world(part, vec![step([0.0, 0.6], 0.1)]));
        let (from, sway, turn) = (DVec3::new(-0.06 * any().x.abs(), 0.0, 0.1 - lowest), 0.02 * any(), 0.2 * any());
        let mut pull = DVec3::ZERO;
        for tick in 0..700 {
            let s = (f64::from(tick) / 600.0).min(1.0);
            let press = DVec3::Z * (0.01 - 0.05 * s);
            let turned = (DQuat::from_scaled_axis(turn * s) * rotation).normalize();
            pull = r.render(&Pose::new(from + sway * s + press, turned), &gains, 1e-3).wrench.force;
        }
        assert!(pull.y.abs() <= 1e-4 * pull.length(), "seed {seed}: {pull} N along an edge without friction");
        held += u32::from(pull.length() > 5.0);
    }
    assert!(held > 40, "{held}");
}
