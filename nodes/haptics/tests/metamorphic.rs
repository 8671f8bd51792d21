//! What must not change the wrench: the choice of the world's axes, handedness, how faces and obstacles are cut up.

mod support;

use cspace::{FixedPart, Polyhedron, World};
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::{DMat3, DQuat, DVec3, Pose, Wrench};
use std::sync::Arc;
use support::random::{prism, wandering};
use support::{block, cuboid, mm, pose, tetrahedron, world};

const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

/// Wrench, SCP, depth, and whether the tracker says that the side is not the nearest one.
type Felt = (Wrench, Pose, f64, bool);

/// A part sliding, rocking and turning in the corner of a floor and a wall and over the floor's border.
fn scene(kind: u64) -> (Arc<World>, impl Fn(f64) -> Pose) {
    let moving = match kind {
        0 => block(mm(16.0, 12.0, 10.0)),
        1 => tetrahedron(20e-3),
        _ => prism(7, 16e-3, 11e-3),
    };
    // Outer faces not flush: where two lie in one plane, two SCPs may be equally right.
    let obstacles =
        vec![cuboid(mm(-30.0, -30.0, -20.0), mm(30.0, 30.0, 0.0)), cuboid(mm(20.0, -27.0, 0.0), mm(28.0, 26.0, 30.0))];
    let motion = wandering(kind, 12.0, 0.6);
    (world(moving, obstacles), move |i| {
        let p = motion(i);
        Pose::new(p.translation + mm(12.0, 12.0, 7.0), p.rotation)
    })
}

fn render(w: &Arc<World>, law: LawKind, path: &dyn Fn(f64) -> Pose) -> Vec<Felt> {
    let gains = Gains { law, ..Gains::default() };
    let mut r = Renderer::new(w.clone());
    (0..3000)
        .map(|i| {
            let out = r.render(&path(f64::from(i)), &gains, 1e-3);
            (out.wrench, out.proxy, out.depth, out.divergent)
        })
        .collect()
}

/// Largest differences of force (N), torque (N.m), SCP (m) and depth (m) after `back` has been applied to the second.
fn differences(one: &[Felt], other: &[Felt], back: &dyn Fn(&Felt) -> (DVec3, DVec3, DVec3, f64)) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    // Deep inside, with another side nearer, which way out is taken may hang on rounding.
    let agreed = one.iter().zip(other).filter(|(a, b)| !a.3 && !b.3);
    assert!(agreed.clone().filter(|(a, _)| a.2 > 0.0).count() > 500, "enough contact to compare");
    for (a, b) in agreed {
        let (f, t, p, d) = back(b);
        let now =
            [(a.0.force - f).length(), (a.0.torque - t).length(), (a.1.translation - p).length(), (a.2 - d).abs()];
        for (w, n) in worst.iter_mut().zip(now) {
            *w = w.max(n);
        }
    }
    worst
}

fn mapped(p: &Polyhedron, map: &dyn Fn(DVec3) -> DVec3, mirrored: bool) -> Polyhedron {
    let v: Vec<DVec3> = p.vertices().iter().map(|v| map(*v)).collect();
    let faces: Vec<Vec<u32>> = p
        .faces()
        .map(|f| {
            let mut ring: Vec<u32> = p.face_vertices(f).iter().map(|v| v.0).collect();
            if mirrored {
                ring.reverse();
            }
            ring
        })
        .collect();
    Polyhedron::from_faces(&v, &faces).expect("still a polyhedron")
}

fn map_fixed(w: &World, map: &dyn Fn(DVec3) -> DVec3, mirrored: bool) -> Vec<FixedPart> {
    w.fixed
        .iter()
        .map(|f| FixedPart { polyhedron: Arc::new(mapped(&f.polyhedron, map, mirrored)), obstacle: f.obstacle })
        .collect()
}

#[test]
fn a_rigid_motion_of_everything_moves_the_wrench_along() {
    let motion = pose(120.0, -75.0, 31.0, 0.7, -0.4, 2.1);
    let back = motion.rotation.conjugate();
    for kind in 0..3 {
        let (w, path) = scene(kind);
        let fixed = map_fixed(&w, &|v| motion.transform_point(v), false);
        let moved = Arc::new(World { moving: w.moving.clone(), fixed });
        for law in LAWS {
            let there = |i: f64| {
                let p = path(i);
                Pose::new(motion.transform_point(p.translation), (motion.rotation * p.rotation).normalize())
            };
            let d = differences(&render(&w, law, &path), &render(&moved, law, &there), &|(wrench, p, depth, _)| {
                let t = back * (p.translation - motion.translation);
                (back * wrench.force, back * wrench.torque, t, *depth)
            });
            println!("{kind} {law:?}: {d:?}");
            assert!(d[0] < 1e-6 && d[1] < 1e-6 && d[2] < 1e-9 && d[3] < 1e-12, "{kind} {law:?}: {d:?}");
        }
    }
}

#[test]
fn the_mirrored_scene_gives_the_mirrored_wrench() {
    let flip = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    for kind in 0..3 {
        let (w, path) = scene(kind);
        let moving = w.moving.iter().map(|p| Arc::new(mapped(p, &flip, true))).collect();
        let mirrored = Arc::new(World { moving, fixed: map_fixed(&w, &flip, true) });
        for law in LAWS {
            let there = |i: f64| {
                let p = path(i);
                let r = mirror * DMat3::from_quat(p.rotation) * mirror;
                Pose::new(flip(p.translation), DQuat::from_mat3(&r).normalize())
            };
            // A torque is an axial vector: its part along the mirror's normal stays.
            let d = differences(&render(&w, law, &path), &render(&mirrored, law, &there), &|(wrench, p, depth, _)| {
                (flip(wrench.force), -flip(wrench.torque), flip(p.translation), *depth)
            });
            println!("{kind} {law:?}: {d:?}");
            assert!(d[0] < 1e-6 && d[1] < 1e-6 && d[2] < 1e-9 && d[3] < 1e-12, "{kind} {law:?}: {d:?}");
        }
    }
}

#[test]
fn faces_cut_into_coplanar_triangles_feel_like_one() {
    for kind in 0..3 {
        let (w, path) = scene(kind);
        let cut = |p: &Polyhedron| {
            let faces: Vec<Vec<u32>> = p
                .faces()
                .flat_map(|f| {
                    let ring: Vec<u32> = p.face_vertices(f).iter().map(|v| v.0).collect();
                    (1..ring.len() - 1).map(|k| vec![ring[0], ring[k], ring[k + 1]]).collect::<Vec<_>>()
                })
                .collect();
            Polyhedron::from_faces(p.vertices(), &faces).expect("coplanar triangles are merged")
        };
        let fixed = w
            .fixed
            .iter()
            .map(|f| FixedPart { polyhedron: Arc::new(cut(&f.polyhedron)), obstacle: f.obstacle })
            .collect();
        let other = Arc::new(World { moving: w.moving.iter().map(|p| Arc::new(cut(p))).collect(), fixed });
        for law in LAWS {
            let d = differences(&render(&w, law, &path), &render(&other, law, &path), &|(wrench, p, depth, _)| {
                (wrench.force, wrench.torque, p.translation, *depth)
            });
            assert!(d[0] < 1e-6 && d[1] < 1e-6 && d[2] < 1e-9 && d[3] < 1e-12, "{kind} {law:?}: {d:?}");
        }
    }
}
