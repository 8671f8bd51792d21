use super::*;
use crate::region::Way;
use crate::solid::{Placed, Sense, Solids};
use crate::testing::cuboid;
use cspace::{FixedPart, World};
use rand::{RngExt, SeedableRng};
use spatial::{DQuat, Pose};
use std::sync::Arc;

/// A floor in two pieces and a wall over it in two, a body of two planks in the hand, or one plank.
fn cut(planks: usize) -> Arc<World> {
    let moving = [([-0.008, -0.005, -0.015], [0.008, 0.005, 0.015]), ([-0.008, 0.005, -0.015], [0.004, 0.009, 0.01])];
    let fixed = [
        ([-0.03, -0.025, -0.01], [0.004, 0.025, 0.0]),
        ([0.004, -0.025, -0.01], [0.03, 0.015, 0.0]),
        ([0.012, -0.025, -0.004], [0.03, 0.002, 0.012]),
        ([0.014, 0.002, -0.004], [0.03, 0.025, 0.012]),
    ];
    let cuboid = |(low, high): ([f64; 3], [f64; 3])| Arc::new(cuboid(low.into(), high.into()));
    Arc::new(World {
        moving: moving[..planks].iter().copied().map(cuboid).collect(),
        fixed: fixed.map(|f| FixedPart { polyhedron: cuboid(f), obstacle: 0 }).into(),
    })
}

#[test]
fn what_was_found_holds_as_long_as_it_says() {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(8);
    // Of types A, B and C: felt, or facing, or not, and kept so.
    let (mut felt, mut facing) = ([[0; 2]; 3], [[0; 2]; 3]);
    for planks in [1, 2] {
        let solids = Solids::new(cut(planks));
        let mut sense = Sense::new(solids.world.clone(), 0.005);
        let lever = solids.lever();
        for _ in 0..6000 {
            let turn = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.5..1.5)));
            let rotation = DQuat::from_scaled_axis(turn * rng.random_range(0.0..1.0)).normalize();
            let at = [-0.02..0.02, -0.02..0.02, 0.0..0.015].map(|range| rng.random_range(range));
            let start = Pose::new(DVec3::from_array(at), rotation);
            sense.reset();
            sense.step(&start);
            let step = 10.0_f64.powf(rng.random_range(-7.0..-3.5));
            let goes = f64::from(rng.random_range(0..2));
            let mut any = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-step..step)));
            let (travel, turn) = (any() * goes, any() / lever);
            for s in &sense.pairs {
                let kind = (s.near.contact.type_letter() as u8 - b'A') as usize;
                let (mut lasting, mut way, mut way_there) = (Lasting::NOTHING, Way::new(lever), Way::new(lever));
                let mut pose = start;
                for _ in 0..20 {
                    let placed = Placed::new(&pose);
                    let pair = Pair::of(&solids, s, &placed);
                    let Some(near) = pair.applicable_plane(s.near.contact) else { break };
                    let gone = way.go(pose.translation, pose.rotation);
                    for covered in [Covered::Unfelt, Covered::Felt] {
                        let known = lasting.felt[covered as usize].of(near.contact, gone);
                        let now = pair.is_felt(&near, covered);
                        felt[kind][usize::from(now)] += usize::from(known.is_some());
                        let found = lasting.is_felt(&near, covered, (gone, lever), || pair);
                        assert_eq!(found, now, "{near:?} {covered:?} at {pose:?}, known {known:?}");
                    }
                    // Where it touches.
                    let touching = placed.shifted(near.normal_w * -near.distance);
                    let pair = Pair { placed: &touching, ..pair };
                    let gone = way_there.go(touching.x, pose.rotation);
                    let known = lasting.facing.of(near.contact, gone);
                    let plane = CFace { distance: 0.0, ..near };
                    let now = facing_point(&pair, &plane, 1e-9).is_some();
                    facing[kind][usize::from(now)] += usize::from(known.is_some());
                    let found = lasting.faces(near.contact, 1e-9, (gone, lever), || (pair, plane));
                    assert_eq!(found, now, "{near:?} faces at {pose:?}, known {known:?}");
                    pose = pose.moved(travel, turn);
                }
            }
        }
    }
    assert!(felt.iter().flatten().chain(facing.iter().flatten()).all(|n| *n > 300), "felt {felt:?}, facing {facing:?}");
}
