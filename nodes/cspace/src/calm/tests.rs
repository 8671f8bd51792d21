use super::*;
use crate::placed::At;
use crate::testing::{some_bodies, some_contact, support, unit};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use spatial::{DQuat, Pose};

/// A pose to which no point of A moves by more than the way.
fn nearby(rng: &mut Pcg64Mcg, a: &Body, pose: &Pose, way: f64) -> Pose {
    let share = rng.random_range(0.0..1.0);
    let turn = DQuat::from_scaled_axis(unit(rng) * ((1.0 - share) * way / a.radius));
    let rotation = (turn * pose.rotation).normalize();
    let center = pose.transform_point(a.center) + unit(rng) * (share * way);
    Pose::new(center - rotation * a.center, rotation)
}

/// The statement of the folded disc, at all poses within the way: where it reaches, no plane is nearer than Near's; and where the same
/// two C-faces lie at the fold, it is no smaller.
#[test]
fn what_a_folded_disc_counts_for_holds_all_the_way() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let (mut folds, mut same, mut least, mut tightest) = (0, 0, f64::INFINITY, f64::INFINITY);
    for _ in 0..12_000 {
        let bodies = some_bodies(&mut rng);
        let [a, b] = &bodies;
        let Some((pose, node)) = some_contact(&mut rng, &bodies) else { continue };
        let way = 10.0_f64.powf(rng.random_range(-6.0..-3.3));
        let at = At::new(a, &pose);
        let placed = Placed::new(a, b, &at);
        let Some(Stays { near, inside, unrest, sine }) = placed.stays(node, way) else { continue };
        let disc = placed.folded_disc_within(&near, unrest, way / a.radius, sine);
        let Some(fold) = placed.fold(&near).filter(|_| disc > inside) else { continue };
        folds += 1;
        for _ in 0..20 {
            let there = nearby(&mut rng, a, &pose, way);
            let at = At::new(a, &there);
            let placed = Placed::new(a, b, &at);
            let Some(near) = placed.plane_if_applicable(node, false) else { continue };
            if let Some(now) = placed.fold(&near).filter(|f| f.across == fold.across) {
                same += 1;
                tightest = tightest.min((now.at_home - now.s).min(now.at_away) - now.s - disc);
            }
            let (e, n) = (-near.distance, near.normal_w);
            for _ in 0..20 {
                let aside = unit(&mut rng).reject_from_normalized(n).normalize();
                let tan_half = rng.random_range(0.0..1.0_f64).cbrt() * (disc / e.max(1e-12)).min(3.0);
                let (cos, sin) = (1.0 - tan_half * tan_half, 2.0 * tan_half);
                let m = (n * cos + aside * sin).normalize();
                least = least.min(support(&bodies, &there, m) - e);
            }
        }
    }
    assert!(least > -1e-13 && tightest > -1e-13, "{least} {tightest}");
    assert!(folds > 500 && same > 10_000 && tightest < 1e-4, "{folds} folds, {same} the same, {tightest}");
}

/// A node that is told to stay applicable is, at all poses within the way.
#[test]
fn what_stays_applicable_is_applicable_all_the_way() {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let (mut told, mut not) = (0, 0);
    for _ in 0..3000 {
        let bodies = some_bodies(&mut rng);
        let [a, b] = &bodies;
        let Some((pose, node)) = some_contact(&mut rng, &bodies) else { continue };
        let way = 10.0_f64.powf(rng.random_range(-6.0..-3.3));
        if !Placed::new(a, b, &At::new(a, &pose)).stays_applicable(node, way) {
            not += 1;
            continue;
        }
        told += 1;
        for _ in 0..50 {
            let there = nearby(&mut rng, a, &pose, way);
            assert!(Placed::new(a, b, &At::new(a, &there)).holds(node), "{node:?} within {way} of {pose:?}");
        }
    }
    assert!(told > 1000 && not > 50, "{told} told, {not} not");
}
