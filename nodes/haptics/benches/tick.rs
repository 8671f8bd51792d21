//! What one rendering costs: the peg on two walls and the bottom of its hole, five pieces, every law.

#[path = "../tests/support/mod.rs"]
mod support;

use criterion::{Criterion, criterion_group, criterion_main};
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use std::hint::black_box;
use support::{peg_in_hole, pose};

fn tick(c: &mut Criterion) {
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
        let gains = Gains { law, ..Gains::default() };
        let mut r = Renderer::new(peg_in_hole());
        // Down the hole and into two walls and the bottom, then trembling there.
        let at = |s: f64, t: f64| {
            let shake = 1e-5 * (37.0 * t).sin();
            let tilt = 2e-4 * (23.0 * t).sin();
            pose(0.3 * s + 1e3 * shake, 0.3 * s, 21.0 - 31.5 * s, tilt, 0.5 * tilt, 0.3 * tilt)
        };
        for i in 0..=1000 {
            r.render(&at(f64::from(i) * 1e-3, 0.0), &gains, 1e-3);
        }
        let mut t = 0.0;
        c.bench_function(&format!("peg in hole, {law:?}"), |b| {
            b.iter(|| {
                t += 1e-3;
                black_box(r.render(&at(1.0, t), &gains, 1e-3).wrench)
            });
        });
    }
}

criterion_group!(benches, tick);
criterion_main!(benches);
