//! The proxy of parts so long that contacts turn them more stiffly than the coupling does.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use support::{block, mm, random, world};

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
