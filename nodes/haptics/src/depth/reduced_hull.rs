//! The nearest point of a contact region to a point: plain, or with weights that bound each contact's share.

use spatial::DVec3;

/// Rounds of the support search; each adds an extreme point, and there are few.
const ROUNDS: usize = 40;

/// `argmin |p - target|` over `p = sum l_k point_k`, `0 <= l_k <= weight_k`, `sum l_k = 1`.
///
/// With all weights 1 this is the nearest point of the convex hull. Needs a weight of at least 1 in total; `order` is
/// scratch of the same length. Wolfe's minimum-norm-point method, with the greedy filling as support function.
pub(crate) fn nearest_point(points: &[DVec3], weights: &[f64], order: &mut [u16], target: DVec3) -> DVec3 {
    debug_assert!(points.len() == weights.len() && order.len() >= points.len());
    match points {
        [] => return target,
        [p] => return *p,
        _ => {}
    }
    let scale = points.iter().map(|p| (*p - target).length_squared()).fold(0.0, f64::max);
    let mut corral = [DVec3::ZERO; 4];
    let mut share = [0.0; 4];
    corral[0] = support(points, weights, order, target - points[0]) - target;
    share[0] = 1.0;
    let mut count = 1;
    let mut best = corral[0];
    for _ in 0..ROUNDS {
        let next = support(points, weights, order, -best) - target;
        if best.length_squared() - best.dot(next) <= 1e-14 * scale || count == 4 {
            break;
        }
        corral[count] = next;
        share[count] = 0.0;
        count += 1;
        best = minimum_norm(&mut corral, &mut share, &mut count);
    }
    target + best
}

/// The extreme point of the weighted hull in `direction`: fill the shares greedily, farthest first.
fn support(points: &[DVec3], weights: &[f64], order: &mut [u16], direction: DVec3) -> DVec3 {
    let order = &mut order[..points.len()];
    for (i, o) in order.iter_mut().enumerate() {
        *o = i as u16;
    }
    // Insertion sort: a dozen points, no allocation.
    for i in 1..order.len() {
        let mut j = i;
        while j > 0 && points[order[j - 1] as usize].dot(direction) < points[order[j] as usize].dot(direction) {
            order.swap(j - 1, j);
            j -= 1;
        }
    }
    let mut left = 1.0_f64;
    let mut sum = DVec3::ZERO;
    for &k in order.iter() {
        let l = left.min(weights[k as usize]);
        sum += points[k as usize] * l;
        left -= l;
        if left <= 0.0 {
            break;
        }
    }
    sum
}

/// The point of least norm in the hull of the corral, which shrinks to the points that carry it.
fn minimum_norm(corral: &mut [DVec3; 4], share: &mut [f64; 4], count: &mut usize) -> DVec3 {
    loop {
        let wanted = affine_minimum(&corral[..*count]);
        // Walk from the present shares to the wanted ones, as far as none turns negative.
        let mut walk = 1.0;
        let mut leaving = None;
        for k in 0..*count {
            if wanted[k] < 0.0 {
                let t = share[k] / (share[k] - wanted[k]);
                if t < walk || leaving.is_none() {
                    walk = t.min(1.0);
                    leaving = Some(k);
                }
            }
        }
        for k in 0..*count {
            share[k] += walk * (wanted[k] - share[k]);
        }
        match leaving {
            Some(k) if *count > 1 => {
                *count -= 1;
                corral.swap(k, *count);
                share.swap(k, *count);
            }
            _ => {
                let mut p = DVec3::ZERO;
                for k in 0..*count {
                    p += corral[k] * share[k];
                }
                return p;
            }
        }
    }
}

/// Shares (summing to one, any sign) of the point of least norm in the affine hull of up to four points.
fn affine_minimum(points: &[DVec3]) -> [f64; 4] {
    // Normal equations of the differences to the first point, by Gram-Schmidt: flat corrals drop out as zero directions.
    let mut wanted = [1.0, 0.0, 0.0, 0.0];
    let n = points.len() - 1;
    let mut q = [DVec3::ZERO; 3];
    let mut upper = [[0.0; 3]; 3];
    for k in 0..n {
        let d = points[k + 1] - points[0];
        let mut rest = d;
        for j in 0..k {
            upper[j][k] = q[j].dot(d);
            rest -= q[j] * upper[j][k];
        }
        let length = rest.length();
        if length > 1e-9 * d.length() {
            q[k] = rest / length;
            upper[k][k] = length;
        }
    }
    let mut c = [0.0; 3];
    for k in (0..n).rev() {
        if upper[k][k] == 0.0 {
            continue;
        }
        let mut right = -q[k].dot(points[0]);
        for j in k + 1..n {
            right -= upper[k][j] * c[j];
        }
        c[k] = right / upper[k][k];
        wanted[k + 1] = c[k];
        wanted[0] -= c[k];
    }
    wanted
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    const SQUARE: [DVec3; 4] =
        [DVec3::new(0.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];

    fn nearest(points: &[DVec3], weights: &[f64], target: DVec3) -> DVec3 {
        nearest_point(points, weights, &mut [0; 16], target)
    }

    #[test]
    fn inside_stays_and_outside_goes_to_the_border() {
        let w = [1.0; 4];
        assert!((nearest(&SQUARE, &w, DVec3::new(0.3, 0.6, 0.0)) - DVec3::new(0.3, 0.6, 0.0)).length() < 1e-12);
        assert!((nearest(&SQUARE, &w, DVec3::new(2.0, 0.5, 0.0)) - DVec3::new(1.0, 0.5, 0.0)).length() < 1e-12);
        assert!((nearest(&SQUARE, &w, DVec3::new(2.0, -3.0, 0.0)) - DVec3::new(1.0, 0.0, 0.0)).length() < 1e-12);
    }

    #[test]
    fn one_full_weight_is_that_point_alone() {
        assert_eq!(nearest(&SQUARE, &[0.0, 1.0, 0.0, 0.0], DVec3::new(0.2, 0.9, 0.0)), SQUARE[1]);
    }

    #[test]
    fn weighted_hull_agrees_with_projected_gradient() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        for _ in 0..200 {
            let n = rng.random_range(2..7_usize);
            let points: Vec<DVec3> =
                (0..n).map(|_| DVec3::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0), 0.0)).collect();
            let mut weights: Vec<f64> = (0..n).map(|_| rng.random_range(0.0..1.0)).collect();
            weights[0] = 1.0;
            let target = DVec3::new(rng.random_range(-2.0..2.0), rng.random_range(-2.0..2.0), 0.0);
            let p = nearest(&points, &weights, target);
            // Optimality: no feasible point lies farther in the direction of the target.
            let ahead = support(&points, &weights, &mut [0; 16], target - p);
            assert!((ahead - p).dot(target - p) < 1e-9, "{p} {ahead} {target}");
        }
    }
}
