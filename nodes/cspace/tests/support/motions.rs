//! Motions of a hand around an obstacle, scaled to the pair.

use super::{Random, rotation, unit};
use rand::RngExt;
use spatial::{DQuat, DVec3, Pose};

pub const MOTIONS: &[&str] =
    &["slide", "tumble", "flat", "edge-on", "through", "coarse", "teleport", "frozen", "press", "aligned-grid"];

/// A point `depth` below the C-obstacle's surface in a random direction, by bisection on `inside`.
fn surface_pose(q: DQuat, direction: DVec3, reach: f64, depth: f64, free: &dyn Fn(&Pose) -> bool) -> Pose {
    let (mut low, mut high) = (0.0, 2.0 * reach);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if free(&Pose::new(direction * middle, q)) { high = middle } else { low = middle }
    }
    Pose::new(direction * (high - depth), q)
}

/// `count` poses of the named motion for bodies centred on their frames; `reach` = sum of their radii, `thin` = sum of
/// their inscribed radii, metres.
pub fn motion(
    name: &str,
    count: usize,
    reach: f64,
    thin: f64,
    rng: &mut Random,
    free: &dyn Fn(&Pose) -> bool,
) -> Vec<Pose> {
    let mut out = Vec::with_capacity(count);
    let q0 = rotation(rng);
    match name {
        // Shallow sliding: the direction wanders, the depth stays within 5 % of the thinner measure.
        "slide" => {
            let (mut d, mut q) = (unit(rng), q0);
            let mut heading = unit(rng);
            for _ in 0..count {
                heading = (heading + unit(rng) * 0.05).normalize();
                d = (d + heading * 0.002).normalize();
                q = (DQuat::from_scaled_axis(unit(rng) * 0.001) * q).normalize();
                let depth = thin * rng.random_range(-0.01..0.05);
                out.push(surface_pose(q, d, reach, depth, free));
            }
        }
        "tumble" => {
            let (axis, mut q, mut d) = (unit(rng), q0, unit(rng));
            for _ in 0..count {
                q = (DQuat::from_axis_angle(axis, 0.02) * q).normalize();
                d = (d + unit(rng) * 0.01).normalize();
                out.push(surface_pose(q, d, reach, thin * rng.random_range(-0.05..0.1), free));
            }
        }
        // Exactly aligned, sliding over a face; offsets that make edges and vertices coincide come by themselves.
        "flat" | "edge-on" => {
            let quarter = std::f64::consts::FRAC_PI_2;
            let mut q = DQuat::IDENTITY;
            if name == "edge-on" {
                q = DQuat::from_rotation_y(0.25 * std::f64::consts::PI);
            }
            let up = surface_pose(q, DVec3::Z, reach, 0.0, free).translation.z;
            let (mut x, mut v) = (DVec3::ZERO, unit(rng) * 0.003 * reach);
            for i in 0..count {
                if i % 997 == 0 {
                    q = DQuat::from_rotation_z(quarter * f64::from(rng.random_range(0..4))) * q;
                    v = unit(rng) * 0.003 * reach;
                }
                x += DVec3::new(v.x, v.y, 0.0);
                for k in 0..2 {
                    if x[k].abs() > 1.1 * reach {
                        v[k] = -x[k].signum() * v[k].abs();
                    }
                }
                out.push(Pose::new(DVec3::new(x.x, x.y, up - thin * 0.02), q));
            }
        }
        // Straight through the obstacle and out of the other side, slowly, again and again.
        "through" => {
            while out.len() < count {
                let (d, q, off) = (unit(rng), rotation(rng), unit(rng) * 0.4 * reach);
                let steps = rng.random_range(60..400);
                for i in 0..steps {
                    let s = 2.0 * f64::from(i) / f64::from(steps) - 1.0;
                    out.push(Pose::new(d * (1.2 * reach * s) + off, q));
                }
            }
            out.truncate(count);
        }
        // 30 % of the size and 15 degrees a sample.
        "coarse" => {
            let (mut x, mut q) = (DVec3::ZERO, q0);
            for _ in 0..count {
                x = (x + unit(rng) * 0.3 * reach).clamp_length_max(1.2 * reach);
                q = (DQuat::from_axis_angle(unit(rng), 15f64.to_radians()) * q).normalize();
                out.push(Pose::new(x, q));
            }
        }
        "teleport" => {
            for _ in 0..count {
                out.push(Pose::new(unit(rng) * rng.random_range(0.0..1.3) * reach, rotation(rng)));
            }
        }
        "frozen" => {
            while out.len() < count {
                let pose = surface_pose(rotation(rng), unit(rng), reach, thin * rng.random_range(-0.1..0.3), free);
                out.extend(std::iter::repeat_n(pose, 50));
            }
            out.truncate(count);
        }
        // In and out along one direction, up to deep.
        "press" => {
            let (mut d, mut q) = (unit(rng), q0);
            for i in 0..count {
                if i % 500 == 0 {
                    (d, q) = (unit(rng), rotation(rng));
                }
                let depth = thin * (0.5 - 0.6 * (i as f64 * std::f64::consts::TAU / 500.0).cos());
                out.push(surface_pose(q, d, reach, depth, free));
            }
        }
        // Right angles and positions on a lattice of the bodies' own size: nothing but ties.
        "aligned-grid" => {
            let quarter = std::f64::consts::FRAC_PI_2;
            let mut x = DVec3::ZERO;
            let mut q = DQuat::IDENTITY;
            for i in 0..count {
                if i % 61 == 0 {
                    let k = |rng: &mut Random| quarter * f64::from(rng.random_range(0..4));
                    q = DQuat::from_rotation_z(k(rng))
                        * DQuat::from_rotation_y(k(rng))
                        * DQuat::from_rotation_x(k(rng));
                    x = (unit(rng) * 8.0).round() * (reach / 16.0);
                }
                let axis = rng.random_range(0..3);
                x[axis] += if rng.random() { reach } else { -reach } / 64.0;
                x = x.clamp(DVec3::splat(-reach), DVec3::splat(reach));
                out.push(Pose::new(x, q));
            }
        }
        _ => panic!("no motion {name}"),
    }
    out
}

/// Poses of A sliding over an obstacle at a constant signed distance `gap` (`< 0`: depth): each sample 0.1 % of the
/// distance of the centres farther, and turned by a milliradian about an axis drawn anew. At 1 kHz and with parts of
/// 100 mm that is 0.1 m/s and 1 rad/s.
pub fn sliding(a: &super::Mesh, b: &super::Mesh, gap: f64, count: usize) -> Vec<Pose> {
    let mut rng = super::random(7);
    let (mut d, mut heading, mut q) = (unit(&mut rng), unit(&mut rng), rotation(&mut rng));
    on_surface(a, b, gap, count, |_| {
        heading = (heading + unit(&mut rng) * 0.02).normalize();
        d = (d + heading * 0.001).normalize();
        q = (DQuat::from_scaled_axis(unit(&mut rng) * 0.001) * q).normalize();
        (d, q)
    })
}

/// The same as a hand does it: `way` metres a sample, and a turn of `turn` radians about an axis that wanders slowly.
pub fn sliding_by_hand(a: &super::Mesh, b: &super::Mesh, gap: f64, count: usize, way: f64, turn: f64) -> Vec<Pose> {
    let mut rng = super::random(7);
    let (mut d, mut heading, mut q) = (unit(&mut rng), unit(&mut rng), rotation(&mut rng));
    let mut axis = unit(&mut rng);
    on_surface(a, b, gap, count, |far| {
        heading = (heading + unit(&mut rng) * 0.02).normalize();
        axis = (axis + unit(&mut rng) * 0.02).normalize();
        d = (d + heading.reject_from_normalized(d).normalize() * (way / far)).normalize();
        q = (DQuat::from_scaled_axis(axis * turn) * q).normalize();
        (d, q)
    })
}

/// Poses at a signed distance `gap`, in the direction and at the orientation that `next` says; it is told how far the
/// last one was.
fn on_surface(
    a: &super::Mesh,
    b: &super::Mesh,
    gap: f64,
    count: usize,
    mut next: impl FnMut(f64) -> (DVec3, DQuat),
) -> Vec<Pose> {
    let (pa, pb) = (super::polyhedron(a), super::polyhedron(b));
    let size = pa.size() + pb.size();
    let mut out = Vec::with_capacity(count);
    let mut high = 2.0 * size;
    let mut tracker = cspace::Tracker::new(pa, pb);
    for _ in 0..count {
        let (d, q) = next(high);
        // Newton along the ray meets the plane exactly.
        for _ in 0..20 {
            let t = tracker.step(&Pose::new(d * high, q));
            let slope = t.near.normal_w.dot(d);
            if slope.abs() < 0.1 || (t.distance - gap).abs() < 1e-9 * size {
                break;
            }
            high -= (t.distance - gap) / slope;
        }
        out.push(Pose::new(d * high, q));
    }
    out
}
