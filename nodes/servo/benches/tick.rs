//! A whole tick: peg in its hole against two walls and the bottom, and free.

use criterion::{Criterion, criterion_group, criterion_main};
use device::Sample;
use haptics::{Gains, LawKind};
use scene::Scene;
use servo::{Config, Tick, TickInput};
use spatial::{DVec3, Pose, Stamp};
use std::hint::black_box;
use std::path::Path;

fn input(i: u64, pose: Pose, law: LawKind) -> TickInput {
    let stamp = Stamp(i as i64 * 1_000_000);
    let sample = Sample { sequence: i + 1, stamp, pose, connected: true, ..Default::default() };
    let gains = Gains { law, ..Gains::default() };
    TickInput { sequence: i, stamp, dt: 1e-3, sample, gains, enabled: true, ..Default::default() }
}

fn ticks(c: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    let scene = Scene::load(&path).expect("the repository's scene");
    let config = Config::default();
    let cases = [("free", DVec3::new(0.0, 0.0, 0.03), 0.0), ("corner", DVec3::new(2e-4, 1.5e-4, 0.0058), 1.0)];
    for (name, end, seated) in cases {
        for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
            let mut tick = Tick::new(&scene, &config);
            let mut i = 0u64;
            // Through the mouth of the hole, so that the part is where a hand would have brought it.
            let start = DVec3::Z * 0.03;
            while i < 500 {
                let s = i as f64 / 500.0;
                let through =
                    if seated > 0.0 { start.lerp(DVec3::Z * end.z, s) + end.with_z(0.0) * s.powi(8) } else { end };
                tick.step(&input(i, Pose::new(through, Pose::IDENTITY.rotation), law));
                i += 1;
            }
            c.bench_function(&format!("tick/{name}/{law:?}"), |b| {
                b.iter(|| {
                    let phase = i as f64 * 0.01;
                    let sway = DVec3::new(phase.sin(), phase.cos(), (1.3 * phase).sin()) * 5e-5;
                    let turn = DVec3::new((0.7 * phase).sin(), 0.0, (0.9 * phase).cos()) * 5e-3;
                    let pose = Pose::new(end, Pose::IDENTITY.rotation).moved(sway, turn);
                    i += 1;
                    black_box(tick.step(black_box(&input(i, pose, law))))
                });
            });
        }
    }
}

criterion_group!(benches, ticks);
criterion_main!(benches);
