//! The tracker against independent oracles, a seeded slice of the large run (`cargo run --release --example oracle`).

mod support;

use cspace::Tracker;
use spatial::{DQuat, DVec3, Pose};
use support::*;

#[test]
fn depth_agrees_with_exhaustive_search_at_random_poses() {
    let shapes = [
        tetrahedron(0.7),
        cuboid(DVec3::new(1.0, 2.0, 0.5)),
        prism(5, 0.8, 0.7),
        cuboid(DVec3::new(2.0, 2.0, 0.02)),
        hull(14, DVec3::ONE, 3),
    ];
    let mut rng = random(1);
    let (mut wrong, mut contacts, mut divergent) = (0, 0, 0);
    for a in &shapes {
        for b in &shapes {
            let (pa, pb) = (polyhedron(a), polyhedron(b));
            let mut tracker = Tracker::new(pa.clone(), pb.clone());
            for _ in 0..60 {
                let pose =
                    Pose::new(unit(&mut rng) * rand::RngExt::random_range(&mut rng, 0.0..2.0), rotation(&mut rng));
                let t = tracker.seed(&pose);
                let truth = exhaustive_distance(&pa, &pb, &pose);
                contacts += u32::from(truth <= 0.0);
                divergent += u32::from(t.divergent);
                if (truth > 0.0) != t.is_free() || (truth <= 0.0 && !t.divergent && (truth - t.distance).abs() > 1e-12)
                {
                    wrong += 1;
                    println!("{:?} truth {truth} tracked {t:?}", (pa.face_count(), pb.face_count()));
                }
            }
        }
    }
    println!("contacts {contacts} divergent {divergent}");
    assert_eq!(wrong, 0);
}

#[test]
fn a_box_slides_flat_on_a_plate() {
    let (a, b) = (cuboid(DVec3::splat(0.1)), cuboid(DVec3::new(1.0, 1.0, 0.01)));
    let mut tracker = Tracker::new(polyhedron(&a), polyhedron(&b));
    let (sa, sb) = (parry_shape(&a), parry_shape(&b));
    let mut worst = 0;
    for i in 0..4000 {
        let x = -0.7 + 1.4 * f64::from(i) / 4000.0;
        let pose = Pose::new(DVec3::new(x, 0.3 * x, 0.055 - 0.001), DQuat::IDENTITY);
        let t = tracker.step(&pose);
        worst = worst.max(t.planes);
        let truth = parry_distance(&sa, &sb, &pose, 1.0).unwrap_or(1.0);
        assert_eq!(t.is_free(), truth > 0.0, "{i} {t:?} {truth}");
        assert!(t.is_free() || t.divergent || (t.distance - truth).abs() < 1e-12, "{i} {t:?} {truth}");
    }
    println!("worst {worst}");
}

/// Every pair and motion of the large run, a few poses each.
#[test]
fn free_and_depth_agree_with_parry_over_all_pairs_and_motions() {
    let mut total = judge::Tally::default();
    for (seed, (name, a, b)) in judge::pairs().into_iter().enumerate() {
        let (pa, pb) = (polyhedron(&a), polyhedron(&b));
        let (reach, thin) = (pa.size() + pb.size(), pa.inner_radius() + pb.inner_radius());
        let free = |p: &Pose| Tracker::new(pa.clone(), pb.clone()).seed(p).is_free();
        for (k, m) in motions::MOTIONS.iter().enumerate() {
            let poses = motions::motion(m, 40, reach, thin, &mut random(7000 * seed as u64 + k as u64), &free);
            let tally = judge::judge(&a, &b, &poses, |i, what| println!("{name} {m} pose {i}: {what}"));
            total.add(&tally);
        }
    }
    println!("{total:?}");
    assert_eq!((total.wrong, total.depth_off), (0, 0));
    assert!(total.contacts > total.poses / 4, "the motions touch");
}
