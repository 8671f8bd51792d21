//! The simulated operator in the real scenes, with the real tick: what it is there for happens, whatever its seed.

use device::{HapticDevice, OperatorConfig, SimulatedOperator};
use haptics::{FormationKind, LawKind};
use scene::Scene;
use servo::{Config, Tick, TickInput, TickRecord, operator_plan};
use spatial::{DVec3, Pose, Stamp, Wrench};
use std::path::Path;

fn load(name: &str) -> Scene {
    Scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../config/scenes/{name}/scene.yaml"))).unwrap()
}

/// Ten seconds of ticks.
fn run(scene: &Scene, seed: u64, law: LawKind) -> Vec<TickRecord> {
    let mut config = Config::default();
    config.gains.law = law;
    let mut tick = Tick::new(scene, &config);
    let operator = OperatorConfig { seed, ..OperatorConfig::default() };
    let mut hand = SimulatedOperator::new(operator, operator_plan(&scene.world).unwrap()).unwrap();
    (0..10_000u64)
        .map(|sequence| {
            let stamp = Stamp(1_000_000_000 + sequence as i64 * 1_000_000);
            let sample = hand.read(stamp);
            let gains = config.gains;
            let record = tick.step(&TickInput {
                sequence,
                stamp,
                dt: 0.001,
                sample,
                gains,
                enabled: true,
                ..TickInput::default()
            });
            hand.write(&record.out_wrench);
            record
        })
        .collect()
}

fn share(records: &[TickRecord], kinds: &[FormationKind]) -> f64 {
    records.iter().filter(|r| kinds.contains(&r.formation.kind)).count() as f64 / records.len() as f64
}

/// How low the peg's lower end came, and how high in the last three seconds, metres; by the pose that `of` picks.
fn tip(records: &[TickRecord], of: impl Fn(&TickRecord) -> Pose) -> (f64, f64) {
    let height = |r: &TickRecord| of(r).transform_point(DVec3::NEG_Z * 0.015).z;
    (
        records.iter().map(height).fold(f64::INFINITY, f64::min),
        records[7000..].iter().map(height).fold(f64::NEG_INFINITY, f64::max),
    )
}

#[test]
fn the_peg_is_seated_and_pulled_out_whatever_the_seed() {
    use FormationKind::{EdgeEdge, EdgeFace, FaceFace, Free, VertexFace};
    let scene = load("peg_in_hole");
    for seed in 1..=10 {
        let records = run(&scene, seed, LawKind::Proxy);
        let (lowest, after) = tip(&records, |r| r.proxy);
        let free = share(&records, &[Free]);
        let one = share(&records, &[VertexFace, EdgeEdge]);
        let more = share(&records, &[EdgeFace, FaceFace]);
        let strongest = records.iter().map(|r| r.out_wrench.force.length()).fold(0.0, f64::max);
        println!("seed {seed}: {:.2} mm, free {free:.2}, one {one:.2}, more {more:.2}, {strongest:.1} N", lowest * 1e3);
        assert!((-0.0091..-0.0088).contains(&lowest), "seed {seed}: the tip reached {lowest} m");
        assert!(after > 0.02, "seed {seed}: the peg was not pulled out, {after} m");
        assert!(free > 0.1 && one > 0.02 && more > 0.1, "seed {seed}: {free} {one} {more}");
        assert!(strongest > 0.5 && strongest < 6.0, "seed {seed}: {strongest} N");
    }
}

#[test]
fn every_law_lets_the_peg_in_and_out() {
    let scene = load("peg_in_hole");
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended] {
        for seed in 1..=3 {
            let records = run(&scene, seed, law);
            let (lowest, _) = tip(&records, |r| r.proxy);
            let (_, after) = tip(&records, |r| r.hip);
            assert!(lowest < -0.008, "{law:?}, seed {seed}: the tip reached {lowest} m");
            assert!(after > 0.02, "{law:?}, seed {seed}: the peg was not pulled out, {after} m");
        }
    }
}

#[test]
fn other_scenes_are_touched_and_left() {
    for name in ["tetra_on_box", "peg_4x4"] {
        let records = run(&load(name), 1, LawKind::Proxy);
        let contact = 1.0 - share(&records, &[FormationKind::Free]);
        assert!((0.1..0.9).contains(&contact), "{name}: in contact {contact} of the time");
        assert!(records.iter().any(|r| r.out_wrench != Wrench::ZERO));
    }
}
