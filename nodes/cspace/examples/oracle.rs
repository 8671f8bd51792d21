//! The large run against parry3d-f64: `cargo run --release -p cspace --example oracle [poses per pair and motion] [pair]`.

#[path = "../tests/support/mod.rs"]
mod support;

use cspace::Tracker;
use support::judge::{Tally, judge, pairs};
use support::motions::{MOTIONS, motion};
use support::{polyhedron, random};

fn main() {
    let mut args = std::env::args().skip(1);
    let count: usize = args.next().and_then(|a| a.parse().ok()).unwrap_or(5000);
    let only = args.next();
    let mut total = Tally::default();
    let mut slide = Tally::default();
    for (seed, (name, a, b)) in pairs().into_iter().enumerate() {
        if only.as_ref().is_some_and(|o| !name.contains(o.as_str())) {
            continue;
        }
        let (pa, pb) = (polyhedron(&a), polyhedron(&b));
        let reach = pa.size() + pb.size();
        let thin = pa.inner_radius() + pb.inner_radius();
        for (k, m) in MOTIONS.iter().enumerate() {
            let mut rng = random(1000 * seed as u64 + k as u64);
            let free = |p: &spatial::Pose| Tracker::new(pa.clone(), pb.clone()).seed(p).is_free();
            let poses = motion(m, count, reach, thin, &mut rng, &free);
            let mut shown = 0;
            let tally = judge(&a, &b, &poses, |i, what| {
                shown += 1;
                if shown <= 3 {
                    println!("  {name} {m} pose {i}: {what}");
                }
            });
            println!("{name:>20} {m:>12} {tally:?}");
            total.add(&tally);
            if *m == "slide" {
                slide.add(&tally);
            }
        }
    }
    println!("slide: {slide:?}\ntotal: {total:?}");
    if total.wrong + total.depth_off > 0 {
        std::process::exit(1);
    }
}
