//! How contacts that crowd together share one contact's weight.

use spatial::DVec3;

/// Contacts closer together than this part of the region's extent share their weight.
const CROWDED: f64 = 0.1;

/// Scratch of [`Shares::spread`].
#[derive(Clone, Debug)]
pub(crate) struct Shares {
    crowd: Vec<f64>,
    capacity: Vec<f64>,
}

impl Shares {
    pub fn new(room: usize) -> Self {
        Self { crowd: Vec::with_capacity(room), capacity: Vec::with_capacity(room) }
    }

    /// Turns the weights (0 to 1) of the contacts at `points` into capacities that do not depend on into how many contacts one
    /// place is cut: a corner that slides over the border of the other face becomes two crossings of edges, and no
    /// weight may come of that.
    ///
    /// Contacts at one place share what the heaviest of them weighs; from a tenth of the region's extent on each keeps its own.
    /// Layer by layer: of the weights between `s` and `s + ds` contact k gets `ds / sum_j near(k, j)` over the contacts
    /// that weigh more than `s`, where `near` falls linearly from 1 to 0. A lone heaviest contact of weight 1 keeps it, and the
    /// total stays at least the largest weight. `order` is scratch of at least the same length.
    pub fn spread(&mut self, points: &[DVec3], weights: &mut [f64], order: &mut [u16]) {
        let n = points.len();
        let order = &mut order[..n];
        let mut count = 0;
        for (i, w) in weights.iter().enumerate() {
            if *w > 0.0 {
                // Insertion sort, heaviest first: a dozen points, no allocation.
                let mut j = count;
                while j > 0 && weights[order[j - 1] as usize] < *w {
                    order[j] = order[j - 1];
                    j -= 1;
                }
                order[j] = i as u16;
                count += 1;
            }
        }
        let order = &order[..count];
        let mut extent = 0.0_f64;
        for (i, k) in order.iter().enumerate() {
            for m in &order[..i] {
                extent = extent.max(points[*k as usize].distance_squared(points[*m as usize]));
            }
        }
        let reach = CROWDED * extent.sqrt();
        if reach <= 0.0 {
            return;
        }
        self.crowd.clear();
        self.capacity.clear();
        self.capacity.resize(n, 0.0);
        for (i, k) in order.iter().enumerate() {
            let mut own = 1.0;
            for (crowd, m) in self.crowd.iter_mut().zip(order) {
                let near = (1.0 - points[*k as usize].distance(points[*m as usize]) / reach).max(0.0);
                *crowd += near;
                own += near;
            }
            self.crowd.push(own);
            let lighter = order.get(i + 1).map_or(0.0, |m| weights[*m as usize]);
            let layer = weights[*k as usize] - lighter;
            for (crowd, m) in self.crowd.iter().zip(order) {
                self.capacity[*m as usize] += layer / crowd;
            }
        }
        weights.copy_from_slice(&self.capacity);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(points: &[DVec3], weights: &[f64]) -> Vec<f64> {
        let mut w = weights.to_vec();
        Shares::new(16).spread(points, &mut w, &mut [0; 16]);
        w
    }

    #[test]
    fn contacts_far_apart_keep_their_weights() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.0, 0.5, 0.0)];
        let weights = [1.0, 0.25, 0.0, 0.7];
        for (found, w) in spread(&points, &weights).iter().zip(weights) {
            assert!((found - w).abs() < 1e-15, "{found} for {w}");
        }
    }

    #[test]
    fn a_contact_cut_in_two_weighs_what_it_weighed() {
        let far = DVec3::X;
        let whole = spread(&[DVec3::ZERO, far], &[1.0, 0.6]);
        let halves = spread(&[DVec3::ZERO, far, far], &[1.0, 0.6, 0.6]);
        assert!((whole[1] - 0.6).abs() < 1e-15 && (halves[1] + halves[2] - 0.6).abs() < 1e-15, "{halves:?}");
        let apart = spread(&[DVec3::ZERO, far, far + DVec3::Y * 0.05], &[1.0, 0.6, 0.6]);
        assert!(apart[1] + apart[2] > 0.7 && apart[1] + apart[2] < 1.2, "{apart:?}");
    }

    #[test]
    fn a_crowd_never_weighs_less_than_its_heaviest() {
        for n in 2..12_u32 {
            let points: Vec<DVec3> = (0..n).map(|i| DVec3::X * (f64::from(i * i) / 50.0)).collect();
            let weights: Vec<f64> = (0..n).map(|i| 1.0 / f64::from(1 + (i * 7) % n)).collect();
            let total: f64 = spread(&points, &weights).iter().sum();
            assert!(total >= 1.0 - 1e-12 && total <= weights.iter().sum::<f64>() + 1e-12, "{n}: {total}");
        }
    }
}
