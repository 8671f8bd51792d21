//! The proxy rests where no free pose beside it is nearer to the hand: where C-faces of a pair meet, the body is free on the side of
//! either, and what belongs to the one must not hold it on the other.

mod support;

use cspace::Polyhedron;
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use support::{mm, penetration, random, world};

/// A roof along the x axis, its edge at z = 0.
fn ridge() -> Polyhedron {
    let ends = [-100.0, 100.0].map(|x| [mm(x, 50.0, -30.0), mm(x, -50.0, -30.0), mm(x, 0.0, 0.0)]);
    random::hull(&ends.concat())
}

/// A spike of three sides, its tip at the origin.
fn spike() -> Polyhedron {
    random::hull(&[mm(0.0, 0.0, 0.0), mm(15.0, 15.0, -80.0), mm(-15.0, 15.0, -80.0), mm(0.0, -20.0, -80.0)])
}

/// What the coupling holds at `pose`, J.
fn energy(gains: &Gains, hip: &Pose, pose: &Pose) -> f64 {
    let (way, turn) = (pose.translation - hip.translation, hip.rotation_to(pose));
    0.5 * (gains.stiffness * way.length_squared() + gains.rotation_stiffness * turn.length_squared())
}

#[test]
fn no_free_pose_beside_the_proxy_is_nearer_to_the_hand() {
    let gains = Gains { law: LawKind::Proxy, proxy_speed: f64::INFINITY, ..Gains::default() };
    let mut rested = 0;
    for seed in 0..24 {
        let mut rng = random::rng(seed);
        let mut u = |most: f64| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-most..most)));
        let points: Vec<DVec3> = (0..14).map(|_| u(1.0).normalize() * 10e-3).collect();
        let w = world(random::hull(&points), vec![if seed % 2 == 0 { ridge() } else { spike() }]);
        let (turn, roll, drift, sway) = (DQuat::from_scaled_axis(u(3.0)), u(0.1), u(2e-3), u(6.0));
        let mut r = Renderer::new(w.clone());
        for i in 0..1200 {
            let s = f64::from(i) / 1200.0;
            let height = (8.0 + 6.0 * (1.0 - 2.0 * s).max(0.0)) * 1e-3;
            let place = DVec3::new(drift.x * s, drift.y * (sway.y * s).sin() * 2.0, height);
            let hip = Pose::new(place, DQuat::from_scaled_axis(roll * (sway * s).x.sin()) * turn);
            let out = r.render(&hip, &gains, 1e-3);
            if i % 25 > 0 || out.energy < 1e-6 {
                continue;
            }
            rested += 1;
            let held = energy(&gains, &hip, &out.proxy);
            let (mut best, mut most) = (0.0_f64, 0.0_f64);
            for _ in 0..120 {
                let mut any = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
                let (dp, dtheta) = (any() * 2e-6, any() * 1e-4);
                let beside = out.proxy.moved(dp, dtheta);
                let gain = held - energy(&gains, &hip, &beside);
                most = most.max(gain);
                if gain > best && penetration(&w, &beside) <= penetration(&w, &out.proxy).max(0.0) + 1e-10 {
                    best = gain;
                }
            }
            assert!(
                best < 0.02 * most,
                "{seed}, tick {i}: {best} J less beside it, {most} J if nothing were in the way"
            );
        }
    }
    assert!(rested > 150, "in contact {rested} times");
}
