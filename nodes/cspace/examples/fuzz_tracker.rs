//! Random polyhedra and wild pose sequences: no panic, no plane that does not support, no freedom claimed or denied
//! wrongly. `cargo run --release -p cspace --example fuzz_tracker -- [minutes] [seed]`; says how many steps it ran.

#[path = "../tests/support/mod.rs"]
mod support;

use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};
use std::time::{Duration, Instant};
use support::judge::{Tally, judge};
use support::*;

fn shape(rng: &mut Random) -> Mesh {
    let size = 10f64.powf(rng.random_range(-1.5..1.0));
    let side = |rng: &mut Random| size * 10f64.powf(rng.random_range(-2.0..0.0));
    match rng.random_range(0..5) {
        0 => tetrahedron(size),
        1 => cuboid(DVec3::new(side(rng), side(rng), side(rng))),
        2 => prism(rng.random_range(3..65), side(rng), side(rng)),
        3 => scaled(cuboid(DVec3::new(1.0, 0.5, 0.25)), size),
        _ => hull(rng.random_range(4..60), DVec3::new(size, side(rng), size), rng.random()),
    }
}

fn main() {
    let mut args = std::env::args().skip(1).filter_map(|a| a.parse::<f64>().ok());
    let minutes = args.next().unwrap_or(10.0);
    let mut rng = random(args.next().unwrap_or(1.0) as u64);
    let end = Instant::now() + Duration::from_secs_f64(60.0 * minutes);
    let (mut total, mut pairs) = (Tally::default(), 0u64);
    while Instant::now() < end {
        let (a, b) = (shape(&mut rng), shape(&mut rng));
        // A hull of very few or nearly flat points may not be a polyhedron: that it is refused is right.
        if [&a, &b].iter().any(|m| cspace::Polyhedron::from_faces(&m.0, &m.1).is_err()) {
            continue;
        }
        let reach = polyhedron(&a).size() + polyhedron(&b).size();
        let quarter = std::f64::consts::FRAC_PI_2;
        let (mut x, mut q) = (unit(&mut rng) * reach, rotation(&mut rng));
        let poses: Vec<Pose> = (0..60)
            .map(|_| {
                match rng.random_range(0..8) {
                    0 => (x, q) = (unit(&mut rng) * rng.random_range(0.0..1.2) * reach, rotation(&mut rng)),
                    1 => q = DQuat::from_axis_angle(DVec3::AXES[rng.random_range(0..3)], quarter),
                    2 => x[rng.random_range(0..3)] = 0.0,
                    3 => q = (DQuat::from_scaled_axis(unit(&mut rng) * 1e-9) * q).normalize(),
                    4 => q = DQuat::IDENTITY,
                    _ => {
                        x = (x + unit(&mut rng) * 10f64.powf(rng.random_range(-8.0..-0.5)) * reach)
                            .clamp_length_max(reach)
                    }
                }
                Pose::new(x, q)
            })
            .collect();
        total.add(&judge(&a, &b, &poses, |i, what| {
            println!("pair {pairs} pose {i}: {what}\n  {a:?}\n  {b:?}\n  {:?}", poses[i])
        }));
        pairs += 1;
    }
    println!("{pairs} pairs, {} steps: {total:?}", total.poses);
    if total.wrong + total.depth_off > 0 {
        std::process::exit(1);
    }
}
