//! How much the wrench changes in one small step while a box rocks on a plate, overhangs its edges and lifts off.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::Pose;
use support::{block, mm, pose, world};

/// Steps of at most about 1e-5 m and 1e-5 rad.
fn motions() -> Vec<(&'static str, Vec<Pose>)> {
    let n = 40_000;
    let path = |f: &dyn Fn(f64) -> Pose| (0..n).map(|i| f(f64::from(i) / f64::from(n))).collect::<Vec<_>>();
    let tau = std::f64::consts::TAU;
    vec![
        ("rocking", path(&|s| pose(1.0, 2.0, 4.2, 0.02 * (2.0 * tau * s).sin(), 0.02 * (3.0 * tau * s).cos(), 0.0))),
        (
            "overhanging",
            path(&|s| {
                let tilt = 0.01 * (4.0 * tau * s).sin();
                pose(29.0 * (tau * s).sin(), 24.0 * (2.0 * tau * s).sin(), 4.3, tilt, 0.7 * tilt, 0.2)
            }),
        ),
        (
            "lifting off",
            path(&|s| {
                pose(
                    26.0,
                    4.0,
                    4.6 + (3.0 * tau * s).sin(),
                    0.015 * (2.0 * tau * s).cos(),
                    0.01 * (5.0 * tau * s).sin(),
                    0.1,
                )
            }),
        ),
    ]
}

/// Largest change in one step over the peak, force and torque.
fn worst(law: LawKind, poses: &[Pose]) -> (f64, f64) {
    let w = world(block(mm(20.0, 16.0, 10.0)), vec![support::cuboid(mm(-25.0, -20.0, -8.0), mm(25.0, 20.0, 0.0))]);
    let gains = Gains { law, ..Gains::default() };
    let mut r = Renderer::new(w);
    let (mut peak_f, mut peak_t, mut step_f, mut step_t) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut last = None;
    for p in poses {
        let out = r.render(p, &gains, 1e-3).wrench;
        peak_f = peak_f.max(out.force.length());
        peak_t = peak_t.max(out.torque.length());
        if let Some(before) = last.replace(out) {
            let change = out - before;
            step_f = step_f.max(change.force.length());
            step_t = step_t.max(change.torque.length());
        }
    }
    (step_f / peak_f, step_t / peak_t)
}

#[test]
fn wrench_is_continuous_across_single_and_multiple_contacts() {
    for (name, poses) in motions() {
        let longest = poses.windows(2).map(|w| (w[1].translation - w[0].translation).length()).fold(0.0, f64::max);
        let turn = poses.windows(2).map(|w| w[0].rotation_to(&w[1]).length()).fold(0.0, f64::max);
        println!("{name}: steps of up to {longest:.1e} m and {turn:.1e} rad");
        for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
            let (f, t) = worst(law, &poses);
            println!("  {law:?}: force {:.2} %, torque {:.2} % of the peak", 100.0 * f, 100.0 * t);
            match law {
                LawKind::Proxy => assert!(f <= 0.01 && t <= 0.01, "{name}: {f} {t}"),
                LawKind::Blended => assert!(f <= 0.03 && t <= 0.03, "{name}: {f} {t}"),
                _ => {}
            }
        }
    }
}
