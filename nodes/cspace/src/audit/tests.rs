use super::*;
use crate::pair_state::STEP_MOVES;
use crate::placed::At;
use crate::testing::{some_bodies, some_contact, support, unit};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Outside the cap every plane is farther than Near's by what the proof says, whatever the directions; and by not much more.
#[test]
fn a_proof_reaches_as_far_as_it_says() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut scratch = AuditScratch::new();
    let (mut proofs, mut tight, mut least) = (0, 0, f64::INFINITY);
    for _ in 0..4000 {
        let bodies = some_bodies(&mut rng);
        let [a, b] = &bodies;
        let Some((pose, node)) = some_contact(&mut rng, &bodies) else { continue };
        let at = At::new(a, &pose);
        let placed = Placed::new(a, b, &at);
        let near = placed.settle(node, false, STEP_MOVES, &mut 0);
        let Verdict::Proven { tan_half_cap, slack } = audit(&placed, &near, &mut scratch, &mut 0) else { continue };
        if slack < 0.0 {
            continue;
        }
        proofs += 1;
        let (e, n) = (-near.face.distance, near.face.normal_w);
        let mut nearest = f64::INFINITY;
        for k in 0..300 {
            let aside = unit(&mut rng).reject_from_normalized(n).normalize();
            // On the border, and beyond it up to the opposite.
            let angle = 2.0 * tan_half_cap.atan();
            let beyond = rng.random_range(0.0..1.0_f64).powi(3) * (std::f64::consts::PI - angle);
            let (sin, cos) = (angle + if k % 2 == 0 { beyond } else { 0.0 }).sin_cos();
            nearest = nearest.min(support(&bodies, &pose, n * cos + aside * sin) - e - slack);
        }
        least = least.min(nearest);
        tight += usize::from(nearest < 0.1 * slack);
    }
    assert!(least > -1e-12, "{least}");
    assert!(proofs > 1000 && tight > 20, "{proofs} proofs, {tight} of them tight");
}
