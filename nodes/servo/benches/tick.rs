//! A whole tick: peg in its hole against two walls and the bottom, and free.

use criterion::{Criterion, criterion_group};
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

/// The peg in the paper's hole: hovering, and pushed to the bottom and into a corner, turning and trembling so that it
/// leans on bottom and walls together. Name, the end of its way (metres), depth of the bottom or none.
const CASES: [(&str, DVec3, bool); 2] =
    [("free", DVec3::new(0.0, 0.0, 0.03), false), ("corner", DVec3::new(2e-4, 1.5e-4, 0.0058), true)];
const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

/// A tick that has been led to the case's end through the mouth of the hole, as a hand would have brought the part.
fn led_there(scene: &Scene, end: DVec3, seated: bool, law: LawKind) -> Tick {
    let mut tick = Tick::new(scene, &Config::default());
    let start = DVec3::Z * 0.03;
    for i in 0..500 {
        let s = i as f64 / 500.0;
        let through = if seated { start.lerp(DVec3::Z * end.z, s) + end.with_z(0.0) * s.powi(8) } else { end };
        tick.step(&input(i, Pose::new(through, Pose::IDENTITY.rotation), law));
    }
    tick
}

/// The `i`-th input of the trembling there.
fn trembling(i: u64, end: DVec3, law: LawKind) -> TickInput {
    let phase = i as f64 * 0.01;
    let sway = DVec3::new(phase.sin(), phase.cos(), (1.3 * phase).sin()) * 5e-5;
    let turn = DVec3::new((0.7 * phase).sin(), 0.0, (0.9 * phase).cos()) * 5e-3;
    input(i, Pose::new(end, Pose::IDENTITY.rotation).moved(sway, turn), law)
}

fn peg_in_hole() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    Scene::load(&path).expect("the repository's scene")
}

fn cpu_ns() -> u64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    t.tv_sec as u64 * 1_000_000_000 + t.tv_nsec as u64
}

/// Prints percentiles of the CPU time of single ticks, the clock's own cost taken off: what the host takes away for others
/// does not count, cache misses and long solves do.
fn percentiles() {
    const TICKS: usize = 200_000;
    let scene = peg_in_hole();
    let mut empty: Vec<u64> = (0..10_000).map(|_| cpu_ns().abs_diff(cpu_ns())).collect();
    empty.sort_unstable();
    let clock = empty[empty.len() / 2];
    for (name, end, seated) in CASES {
        for law in LAWS {
            let mut tick = led_there(&scene, end, seated, law);
            let mut times = Vec::with_capacity(TICKS);
            let (mut contacts, mut most_pieces) = (0, 0);
            for i in 500..500 + TICKS as u64 {
                let input = trembling(i, end, law);
                let start = cpu_ns();
                let record = black_box(tick.step(black_box(&input)));
                times.push((cpu_ns() - start).saturating_sub(clock));
                let points = record.formation.points();
                contacts += points.len();
                let pieces = points.iter().fold(0u64, |set, p| set | 1 << (p.piece_b % 64)).count_ones();
                most_pieces = most_pieces.max(pieces);
            }
            times.sort_unstable();
            let at = |share: f64| times[((TICKS - 1) as f64 * share) as usize] as f64 * 1e-3;
            println!(
                "tick/{name}/{law:?}: CPU time p50 {:.2} p99 {:.2} p99.9 {:.2} us; {:.1} contacts, up to {most_pieces} pieces",
                at(0.5),
                at(0.99),
                at(0.999),
                contacts as f64 / TICKS as f64,
            );
        }
    }
}

fn ticks(c: &mut Criterion) {
    let scene = peg_in_hole();
    for (name, end, seated) in CASES {
        for law in LAWS {
            let mut tick = led_there(&scene, end, seated, law);
            let mut i = 500;
            c.bench_function(&format!("tick/{name}/{law:?}"), |b| {
                b.iter(|| {
                    i += 1;
                    black_box(tick.step(black_box(&trembling(i, end, law))))
                });
            });
        }
    }
}

criterion_group!(benches, ticks);

fn main() {
    percentiles();
    benches();
    Criterion::default().configure_from_args().final_summary();
}
