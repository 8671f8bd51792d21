//! Slow closed loops give no energy; friction only takes it.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::{DVec3, Pose};
use support::{block, cuboid, mm, pose, world};

/// Work done on the hand along the closed path (J), and the sum of its absolute values.
fn work(w: &std::sync::Arc<cspace::World>, gains: &Gains, path: &dyn Fn(f64) -> Pose, n: u32) -> (f64, f64) {
    let mut r = Renderer::new(w.clone());
    // From outside, in the loop's first orientation, and once around: the loop starts where it ends.
    let first = path(0.0);
    for i in 0..=1000 {
        r.render(
            &Pose::new(first.translation + DVec3::Z * 3e-3 * (1.0 - f64::from(i) / 1e3), first.rotation),
            gains,
            1.0,
        );
    }
    let mut last: Option<(Pose, spatial::Wrench)> = None;
    let (mut sum, mut size) = (0.0, 0.0);
    for lap in 0..2 {
        for i in 0..=n {
            let p = path(f64::from(i) / f64::from(n));
            let out = r.render(&p, gains, 1.0).wrench;
            if let (1, Some((q, before))) = (lap, last) {
                let mean = (out + before) * 0.5;
                let done = mean.force.dot(p.translation - q.translation) + mean.torque.dot(q.rotation_to(&p));
                sum += done;
                size += done.abs();
            }
            last = Some((p, out));
        }
    }
    (sum, size)
}

#[test]
fn closed_loops_return_nothing_without_friction() {
    let tau = std::f64::consts::TAU;
    let floor = cuboid(mm(-40.0, -40.0, -20.0), mm(40.0, 40.0, 0.0));
    let wall = cuboid(mm(15.0, -40.0, -20.0), mm(40.0, 40.0, 40.0));
    let w = world(block(mm(10.0, 8.0, 6.0)), vec![floor, wall]);
    let in_contact = |s: f64| {
        let (c, d) = ((tau * s).cos(), (tau * s).sin());
        // Pressed, slid, turned and tilted, always on the floor and the wall.
        pose(11.0 + 0.4 * c, 3.0 * d, 2.0 + 0.3 * d, 0.02 * c, 0.03 * d, 0.1 * c)
    };
    let gains = Gains { law: LawKind::Proxy, proxy_speed: f64::INFINITY, ..Gains::default() };
    // The trapezoid rule errs by h^2 within a contact, and a little where contacts come and go: fine steps.
    let (sum, size) = work(&w, &gains, &in_contact, 160_000);
    println!("proxy: {sum:e} J of {size:e} J moved");
    assert!(sum.abs() <= 1e-9 * size, "{sum:e} of {size:e}");
    // Translation only: the piecewise linear force of the single contact makes the trapezoid rule exact.
    let sliding =
        |s: f64| pose(3.0 * (tau * s).cos(), 3.0 * (tau * s).sin(), 2.0 + 0.5 * (tau * s).sin(), 0.3, 0.2, 0.1);
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
        let gains = Gains { law, ..gains };
        let (sum, size) = work(&w, &gains, &sliding, 4000);
        println!("{law:?}, sliding: {sum:e} J of {size:e} J moved");
        assert!(sum.abs() <= 1e-9 * size, "{law:?}: {sum:e} of {size:e}");
    }
}

#[test]
fn friction_only_takes_energy_and_holds_below_the_cone() {
    let w = world(block(mm(10.0, 8.0, 6.0)), vec![cuboid(mm(-40.0, -40.0, -20.0), mm(40.0, 40.0, 0.0))]);
    let gains = Gains { friction_static: 0.5, friction_kinetic: 0.4, proxy_speed: f64::INFINITY, ..Gains::default() };
    let tau = std::f64::consts::TAU;
    for radius in [0.05, 0.5, 4.0] {
        let circle = |s: f64| pose(radius * ((tau * s).cos() - 1.0), radius * (tau * s).sin(), 2.0, 0.0, 0.0, 0.0);
        let (sum, size) = work(&w, &gains, &circle, 8000);
        println!("circle of {radius} mm: {sum:e} J of {size:e} J moved");
        assert!(sum <= 1e-9 * size, "{sum:e}");
    }
    // 1 mm deep is 1 N: pulled sideways, it sticks up to 0.5 N and slides with 0.4 N.
    let mut r = Renderer::new(w);
    let mut sideways = Vec::new();
    r.render(&pose(0.0, 0.0, 4.0, 0.0, 0.0, 0.0), &gains, 1e-3);
    for i in 0..=1000 {
        r.render(&pose(0.0, 0.0, 4.0 - 2.0 * f64::from(i) / 1e3, 0.0, 0.0, 0.0), &gains, 1e-3);
    }
    for i in 0..=1000 {
        let f = r.render(&pose(2.0 * f64::from(i) / 1e3, 0.0, 2.0, 0.0, 0.0, 0.0), &gains, 1e-3).wrench.force;
        assert!((f.z - 1.0).abs() < 1e-6, "{f}");
        sideways.push(-f.x);
    }
    let peak = sideways.iter().copied().fold(0.0, f64::max);
    assert!(peak <= 0.5 + 1e-9 && peak > 0.495, "{peak}");
    assert!((sideways[1000] - 0.4).abs() < 1e-6, "{}", sideways[1000]);
}

#[test]
fn friction_in_a_corner_adds_up_and_never_drives() {
    let tau = std::f64::consts::TAU;
    let floor = cuboid(mm(-40.0, -40.0, -20.0), mm(40.0, 40.0, 0.0));
    let wall = cuboid(mm(15.0, -40.0, -20.0), mm(40.0, 40.0, 40.0));
    let w = world(block(mm(10.0, 8.0, 6.0)), vec![floor, wall]);
    let gains = Gains { friction_static: 0.3, friction_kinetic: 0.3, proxy_speed: f64::INFINITY, ..Gains::default() };
    // 1 mm into the floor and 2 mm into the wall, pulled along both: both hold back.
    let mut r = Renderer::new(w.clone());
    let mut along = 0.0;
    for i in 0..=2000 {
        let p = pose(12.0_f64.min(9.0 + 0.01 * f64::from(i)), 0.003 * f64::from(i), 2.0, 0.0, 0.0, 0.0);
        along = -r.render(&p, &gains, 1e-3).wrench.force.y;
    }
    assert!((along - 0.3 * (1.0 + 2.0)).abs() < 1e-3, "{along}");
    // Turned against both faces, the two could hold as a couple; on the way round they only take.
    for k in 0..8 {
        let turn = tau * f64::from(k) / 8.0;
        let path = |s: f64| {
            let (c, d) = ((tau * s + turn).cos(), (tau * s).sin());
            pose(11.0 + 0.5 * d, 0.6 * c, 2.3 + 0.3 * c, 0.01 * d, 0.015 * c, 0.02 * c)
        };
        let (sum, size) = work(&w, &gains, &path, 2000);
        println!("corner, {k}: {sum:e} J of {size:e} J moved");
        assert!(sum < -0.02 * size, "{k}: {sum:e} of {size:e}");
    }
}

/// Within one contact formation the depth laws are minus the gradient of the energy: what a loop leaves over is the trapezoid
/// rule's, which falls with the square of the step.
#[test]
fn depth_laws_return_what_they_took_while_the_contact_stays_the_same() {
    let tau = std::f64::consts::TAU;
    let w = world(block(mm(20.0, 16.0, 10.0)), vec![cuboid(mm(-40.0, -40.0, -20.0), mm(12.0, 40.0, 0.0))]);
    // One corner on the top; and an edge over the border.
    let vertex = |s: f64| {
        let (c, d) = ((tau * s).cos(), (tau * s).sin());
        let p = pose(3.0 * d - 8.0, 4.0 * c, 0.0, 0.3 + 0.05 * d, 0.4 + 0.04 * c, 0.1 * d);
        lowered(p, mm(10.0, 8.0, 5.0), 6e-4 + 3e-4 * (2.0 * tau * s).sin())
    };
    let edges = |s: f64| {
        let (c, d) = ((tau * s).cos(), (tau * s).sin());
        pose(15.2 + 0.1 * d, 2.0 * c, 6.0 + 0.1 * c, 0.25 + 0.01 * d, 0.7 + 0.01 * c, 0.02 * d)
    };
    let paths: [(&str, &dyn Fn(f64) -> Pose); 2] = [("vertex-face", &vertex), ("edge-edge", &edges)];
    for (name, path) in paths {
        for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended] {
            let gains = Gains { law, ..Gains::default() };
            let part = |n: u32| {
                let (sum, size) = work(&w, &gains, path, n);
                println!("{law:?}, {name}, {n} steps: {sum:e} J of {size:e} J moved");
                assert!(size > 1e-5, "{law:?}, {name}: {size:e} J moved");
                sum.abs() / size
            };
            let (coarse, fine) = (part(2_000), part(40_000));
            assert!(fine <= 1e-9 && fine < 0.01 * coarse, "{law:?}, {name}: {coarse:e}, {fine:e}");
        }
    }
}

/// The pose at the height at which a box of these half sides is `depth` metres deep in the plane z = 0.
fn lowered(p: Pose, half: DVec3, depth: f64) -> Pose {
    let lowest = p.rotation_matrix().transpose().z_axis.abs().dot(half);
    Pose::new(DVec3::new(p.translation.x, p.translation.y, lowest - depth), p.rotation)
}

/// Where contacts come and go the torque of `paper` and `pstar` is still minus the gradient of the energy, which has kinks there: a
/// trapezoid across one errs by as much as its step is long. Only where two contacts' depths differ by less than what counts as
/// equal, a millionth of the size, it is that of the edge or the face: what that leaves over is the force times this. `blended` rounds the kinks off, by rule and not by a gradient, while
/// the part tilts by what the contacts fade over: no more than a part of the force times that depth is gained or lost.
#[test]
fn rocking_loops_are_bounded_by_the_step_and_by_the_blend() {
    let tau = std::f64::consts::TAU;
    let half = mm(20.0, 16.0, 10.0);
    let w = world(block(2.0 * half), vec![cuboid(mm(-150.0, -150.0, -20.0), mm(150.0, 150.0, 0.0))]);
    let rocking = |s: f64| {
        let (c, d) = ((tau * s).cos(), (tau * s).sin());
        let p = pose(20.0 * d, 15.0 * c, 0.0, 0.02 * (2.0 * tau * s).sin(), 0.02 * (3.0 * tau * s).cos(), 0.1 * d);
        lowered(p, half, 3e-4 + 6e-4 * (2.0 * tau * s).sin())
    };
    for law in [LawKind::Paper, LawKind::Pstar] {
        let gains = Gains { law, ..Gains::default() };
        let part = |n: u32| {
            let (sum, size) = work(&w, &gains, &rocking, n);
            println!("{law:?}, rocking, {n} steps: {sum:e} J of {size:e} J moved");
            sum.abs() / size
        };
        let (coarse, fine) = (part(2_000), part(16_000));
        assert!(fine <= 0.2 * coarse && fine <= 3e-4, "{law:?}: {coarse:e}, {fine:e}");
    }
    for blend_depth in [5e-4, 5e-5] {
        let gains = Gains { law: LawKind::Blended, blend_depth, ..Gains::default() };
        let (sum, size) = work(&w, &gains, &rocking, 8_000);
        println!("Blended over {blend_depth:e} m, rocking: {sum:e} J of {size:e} J moved");
        assert!(sum.abs() <= 0.3 * 0.9 * blend_depth, "{sum:e} J of {size:e} J moved");
    }
}
