//! Random parts, crowds of obstacles and smooth motions, the same for the same seed.

use super::{block, pose, tetrahedron, world};
use cspace::{Polyhedron, World};
use rand::{RngExt, SeedableRng};
use spatial::{DVec3, Pose};
use std::sync::Arc;

pub type Rng = rand_pcg::Pcg64;

pub fn rng(seed: u64) -> Rng {
    Rng::seed_from_u64(seed)
}

/// The convex hull of the points, by parry.
pub fn hull(points: &[DVec3]) -> Polyhedron {
    let (vertices, triangles) = parry3d_f64::transformation::convex_hull(points);
    let faces: Vec<Vec<u32>> = triangles.iter().map(|t| t.to_vec()).collect();
    Polyhedron::from_faces(&vertices, &faces).expect("a hull is a polyhedron")
}

/// A prism of `n` sides, `width` across its corners and `height` high, about the origin.
pub fn prism(n: usize, width: f64, height: f64) -> Polyhedron {
    let corner = |i: usize| {
        let a = (i / 2) as f64 / n as f64 * std::f64::consts::TAU;
        DVec3::new(0.5 * width * a.cos(), 0.5 * width * a.sin(), if i.is_multiple_of(2) { 0.5 } else { -0.5 } * height)
    };
    hull(&(0..2 * n).map(corner).collect::<Vec<_>>())
}

/// A box, a tetrahedron, a prism, a ball of 14 points or a plate, about `size` metres wide.
pub fn body(rng: &mut Rng, size: f64) -> Polyhedron {
    let kind = rng.random_range(0..5);
    let mut u = |low: f64, high: f64| rng.random_range(low..high);
    match kind {
        0 => block(DVec3::new(u(0.3, 1.0), u(0.3, 1.0), u(0.3, 1.0)) * size),
        1 => tetrahedron(size),
        2 => prism(u(3.0, 9.0) as usize, size, u(0.3, 1.0) * size),
        3 => {
            let mut point = || DVec3::new(u(-1.0, 1.0), u(-1.0, 1.0), u(-1.0, 1.0)).normalize_or(DVec3::X) * 0.5 * size;
            hull(&(0..14).map(|_| point()).collect::<Vec<_>>())
        }
        _ => block(DVec3::new(u(0.05, 0.2), u(0.5, 1.0), u(0.5, 1.0)) * size),
    }
}

/// The body at a pose, as vertices in W.
pub fn placed(body: &Polyhedron, at: &Pose) -> Polyhedron {
    hull(&body.vertices().iter().map(|v| at.transform_point(*v)).collect::<Vec<_>>())
}

/// One body among up to four obstacles that overlap at random.
pub fn crowd(seed: u64) -> Arc<World> {
    let mut rng = rng(seed);
    let moving = body(&mut rng, 20e-3);
    let n = rng.random_range(1..5);
    let fixed = (0..n)
        .map(|_| {
            let b = body(&mut rng, 40e-3);
            let mut s = |s: f64| rng.random_range(-s..s);
            placed(&b, &pose(s(25.0), s(25.0), s(25.0), s(3.0), s(1.5), s(3.0)))
        })
        .collect();
    world(moving, fixed)
}

/// Sums of three sines in each of six directions, `span` mm and `turn` rad, with `i` counting milliseconds.
pub fn wandering(seed: u64, span: f64, turn: f64) -> impl Fn(f64) -> Pose {
    let mut rng = rng(seed ^ 0x55);
    let waves: [[(f64, f64, f64); 3]; 6] = std::array::from_fn(|_| {
        std::array::from_fn(|_| (rng.random_range(1.0..6.0), rng.random_range(0.0..6.3), rng.random_range(0.2..1.0)))
    });
    move |i| {
        let t = i * 1e-3;
        let v: [f64; 6] =
            std::array::from_fn(|k| waves[k].iter().map(|(w, p, a)| a * (w * t + p).sin()).sum::<f64>() / 2.0);
        pose(span * v[0], span * v[1], span * v[2], turn * v[3], turn * v[4], turn * v[5])
    }
}
