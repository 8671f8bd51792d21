use super::*;
use crate::region::{Clipper, Way};
use crate::solid::{Covered, Placed, Sense, Solids};
use crate::testing::cuboid;
use cspace::{FixedPart, World};
use rand::{RngExt, SeedableRng};
use spatial::{DQuat, Pose};
use std::sync::Arc;

/// A corner of a floor in two pieces and a wall beside it, two planks in the hand.
fn corner() -> Arc<World> {
    let moving = [([-0.008, -0.005, -0.015], [0.008, 0.005, 0.015]), ([-0.008, 0.005, -0.015], [0.008, 0.009, 0.01])];
    let fixed = [
        ([-0.03, -0.025, -0.01], [0.004, 0.025, 0.0]),
        ([0.004, -0.025, -0.01], [0.012, 0.025, 0.0]),
        ([0.012, -0.025, -0.01], [0.03, 0.025, 0.012]),
    ];
    let cuboid = |(low, high): ([f64; 3], [f64; 3])| Arc::new(cuboid(low.into(), high.into()));
    Arc::new(World {
        moving: moving.map(cuboid).into(),
        fixed: fixed.map(|f| FixedPart { polyhedron: cuboid(f), obstacle: 0 }).into(),
    })
}

#[test]
fn what_a_vertex_or_an_edge_decides_is_what_clipping_finds() {
    let solids = Solids::new(corner());
    let (mut sense, mut clipper) = (Sense::new(solids.world.clone(), 0.005), Clipper::for_world(&solids.world));
    let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
    let (mut quick, mut clipped) = (Vec::with_capacity(64), Vec::with_capacity(64));
    let mut settled = [0; 4];
    let (mut left, mut held) = (0, 0);
    let lever = solids.lever();
    let mut way = Way::new(lever);
    let mut known = vec![Known::NOTHING; solids.world.moving.len() * solids.world.fixed.len()];
    for _ in 0..12_000 {
        // Upright, or on an edge, and turned from there by very little about some axes.
        let mut small = || if rng.random_bool(0.4) { 0.0 } else { 10.0_f64.powf(rng.random_range(-9.0..-1.5)) };
        let tilt = DQuat::from_scaled_axis(DVec3::new(small(), -small(), small()));
        let quarter = f64::from(rng.random_range(0..8)) * std::f64::consts::FRAC_PI_4;
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][rng.random_range(0..3)];
        let rotation = (tilt * DQuat::from_axis_angle(axis, quarter)).normalize();
        let turned = |v: DVec3| rotation * v;
        let extent = |axis: fn(DVec3) -> f64| {
            let all = solids.world.moving.iter().flat_map(|p| p.vertices()).map(|v| axis(turned(*v)));
            all.fold(0.0, f64::max)
        };
        let (down, ahead) = (extent(|v| -v.z), extent(|v| v.x));
        // Into the floor, and anywhere, or into the wall as well, or only so far that both are just touched.
        let mut little = || 10.0_f64.powf(rng.random_range(-11.0..-4.0));
        let (into_floor, into_wall) = (little(), little());
        let (x, z) = match rng.random_range(0..3) {
            0 => (rng.random_range(-0.02..0.02), down - 1e-4),
            1 => (0.012 - ahead + into_wall, down - 1e-4),
            _ => (0.012 - ahead + into_wall, down - into_floor),
        };
        let mut pose = Pose::new(DVec3::new(x, rng.random_range(-0.02..0.02), z), rotation);
        sense.reset();
        known.fill(Known::NOTHING);
        // There, and on from there: what is known must still hold.
        let step = 10.0_f64.powf(rng.random_range(-8.0..-4.0));
        let mut any = || DVec3::from_array(std::array::from_fn(|_| rng.random_range(-step..step)));
        let (travel, turn) = (any(), any() / lever);
        for _ in 0..5 {
            sense.step(&pose);
            let placed = Placed::new(&pose);
            let gone = way.go(pose.translation, pose.rotation);
            for s in sense.pairs.iter().filter(|s| s.near.distance < 0.0) {
                let pair = Pair::of(&solids, s, &placed);
                let Some(plane) = pair.felt_plane(&s.near, Covered::Felt, &mut None) else { continue };
                let within = 2.0 * pair.a.size() * TIED;
                let scope = Scope { reach: plane.distance + within, near_felt: true, wide: false, along_near: true };
                quick.clear();
                let known = &mut known[pair.part * solids.world.fixed.len() + pair.piece];
                held += usize::from(known.holds(plane.contact, within, gone));
                if !tied_contacts(&pair, &plane, within, &scope, (known, gone, lever), &mut quick) {
                    left += 1;
                    continue;
                }
                settled[quick.len()] += 1;
                clipped.clear();
                clipper.region(&pair, &plane, &scope, &mut clipped);
                let missing = |from: &[RegionPoint], of: &[RegionPoint]| {
                    of.iter().any(|p| {
                        let same = |q: &RegionPoint| {
                            q.contact == p.contact
                                && q.point_w.distance(p.point_w) < 1e-12
                                && (q.gap - p.gap).abs() < 1e-14
                                && q.normal_w.distance(p.normal_w) < 1e-9
                        };
                        // At the very limit rounding decides.
                        p.gap < scope.reach - 1e-14 && !from.iter().any(same)
                    })
                };
                let differ = missing(&quick, &clipped) || missing(&clipped, &quick);
                assert!(!differ, "{pose:?} {plane:?}: {quick:?}, clipped {clipped:?}");
            }
            pose = pose.moved(travel, turn);
        }
    }
    assert!(
        settled[..3].iter().all(|n| *n > 1000),
        "nothing, one and two contacts {settled:?}, left to clipping {left}"
    );
    assert!(held > 10_000, "known {held}");
}
