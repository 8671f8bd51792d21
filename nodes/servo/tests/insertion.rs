//! The simulated operator inserts the pegs, and the loop gives the hand no energy.

use device::{HapticDevice, OperatorConfig, SimulatedOperator};
use haptics::{FormationKind, LawKind};
use scene::Scene;
use servo::{Config, Health, Tick, TickInput, operator_plan};
use spatial::{DVec3, Pose, Stamp, Wrench};
use std::path::Path;

/// What came of a run.
#[derive(Debug)]
struct Run {
    /// Lowest height of the peg's tip, metres.
    lowest: f64,
    /// Greatest net energy given to the hand up to any moment, J.
    given: f64,
    health: Health,
    formations: Vec<FormationKind>,
    /// How far the proxy's corners reached into the plate, metres.
    penetration: f64,
}

fn run(name: &str, seed: u64, law: LawKind, seconds: f64) -> Run {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes").join(name).join("scene.yaml");
    let scene = Scene::load(&path).unwrap();
    let mut config = Config::default();
    config.gains.law = law;
    let operator = OperatorConfig { seed, ..config.device.operator };
    let mut hand = SimulatedOperator::new(operator, operator_plan(&scene.world).unwrap()).unwrap();
    let mut tick = Tick::new(&scene, &config);
    let mut run = Run { lowest: 1.0, given: 0.0, health: Health::GOOD, formations: Vec::new(), penetration: 0.0 };
    let (mut work, mut last, mut shown) = (0.0, None::<Pose>, Wrench::ZERO);
    for i in 0..(seconds * 1000.0) as u64 {
        let stamp = Stamp(1_000_000 * (i as i64 + 1));
        let sample = hand.read(stamp);
        let input = TickInput {
            sequence: i,
            stamp,
            dt: 1e-3,
            sample,
            gains: config.gains,
            enabled: true,
            ..Default::default()
        };
        let r = tick.step(&input);
        let pose = sample.pose;
        let before = last.replace(pose).unwrap_or(pose);
        work += shown.force.dot(pose.translation - before.translation) + shown.torque.dot(before.rotation_to(&pose));
        run.given = run.given.max(work);
        hand.write(&r.out_wrench);
        shown = r.out_wrench;
        run.health.set(r.health);
        run.lowest = run.lowest.min(r.proxy.transform_point(DVec3::NEG_Z * 0.015).z);
        if !run.formations.contains(&r.formation.kind) {
            run.formations.push(r.formation.kind);
        }
        for part in &scene.world.moving {
            for v in part.vertices() {
                let p = r.proxy.transform_point(*v);
                for piece in &scene.world.fixed {
                    let b = &piece.polyhedron;
                    let outside = b.faces().map(|f| b.face_plane(f).signed_distance(p)).fold(f64::MIN, f64::max);
                    run.penetration = run.penetration.max(-outside);
                }
            }
        }
    }
    run
}

/// 100 hands with tremor, each holding the peg 2 degrees askew and aiming beside the mark.
fn insert_all(name: &str) {
    let mut worst = Run { lowest: -1.0, given: 0.0, health: Health::GOOD, formations: Vec::new(), penetration: 0.0 };
    for seed in 0..100 {
        let r = run(name, seed, LawKind::Proxy, 9.5);
        assert!((r.lowest + 0.009).abs() < 1e-6, "seed {seed}: not at the bottom: {r:?}");
        assert!(r.given <= 1e-6, "seed {seed}: energy into the hand: {r:?}");
        assert!(r.penetration <= 1e-7, "seed {seed}: the proxy penetrates: {r:?}");
        let trouble = Health::ZERO_FORCE | Health::JUMP | Health::ENERGY;
        assert!(!r.health.any(trouble), "seed {seed}: {}", r.health);
        for kind in [FormationKind::Free, FormationKind::VertexFace, FormationKind::EdgeFace, FormationKind::FaceFace] {
            assert!(r.formations.contains(&kind), "seed {seed}: never {}: {r:?}", kind.name());
        }
        worst.lowest = worst.lowest.max(r.lowest);
        worst.given = worst.given.max(r.given);
        worst.penetration = worst.penetration.max(r.penetration);
    }
    println!("{name}: worst of 100: {worst:?}");
}

#[test]
fn the_rectangular_peg_goes_to_the_bottom_and_takes_no_energy() {
    insert_all("peg_in_hole");
}

#[test]
fn the_square_peg_goes_to_the_bottom_and_takes_no_energy() {
    insert_all("peg_4x4");
}
