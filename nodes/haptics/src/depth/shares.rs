//! How the contacts of a region share what weight they have.

use spatial::DVec3;

/// Contacts closer together than this part of the region's extent share their weight.
const CROWDED: f64 = 0.1;
/// A contact at which the region's border turns by less than this, radians, counts by that part.
const CORNER: f64 = 0.2;
/// Contacts closer together than this part of the extent are one.
const SAME_PLACE: f64 = 1e-9;

/// Scratch of [`Shares::spread`].
#[derive(Clone, Debug)]
pub(crate) struct Shares {
    /// The corners of the convex hull, counter-clockwise about the normal, as indices of contacts.
    ring: Vec<u16>,
    /// How much of a corner each of them is, 0 to 1.
    corner: Vec<f64>,
    /// Of the contacts.
    weights: Vec<f64>,
    capacity: Vec<f64>,
}

impl Shares {
    pub fn new(room: usize) -> Self {
        Self {
            ring: Vec::with_capacity(room),
            corner: Vec::with_capacity(room),
            weights: Vec::with_capacity(room),
            capacity: Vec::with_capacity(room),
        }
    }

    /// Turns the weights (0 to 1) of the contacts at `points`, in one plane with this normal, into capacities that do not depend on
    /// into how many contacts one region is cut: a corner that slides over the border of the other face becomes two crossings of
    /// edges, a flat face that is given as two facets has crossings along its diagonal, and no weight may come of that.
    ///
    /// Layer by layer: of the weights between `s` and `s + ds` go to contact k, of those that weigh more than `s`, `ds corner(k) /
    /// max(1, sum_j near(k, j) corner(j))`. Here `corner` is the angle by which the border of their convex hull turns at the
    /// contact, from nought (within the hull, or on a side) to 1 for [`CORNER`] and more, and `near` falls linearly from 1 to 0 at
    /// a tenth of the hull's extent. Blunt contacts (`sharpness` less than 1) weigh less by as much, but in the layers that would
    /// then be empty. A lone heaviest contact of weight 1 keeps it, and the total stays at least the largest weight.
    /// `order` is scratch of at least the same length.
    pub fn spread(
        &mut self,
        points: &[DVec3],
        normal: DVec3,
        weights: &mut [f64],
        sharpness: &[f64],
        order: &mut [u16],
    ) {
        self.capacity.clear();
        self.capacity.resize(points.len(), 0.0);
        let most = weights.iter().copied().fold(0.0, f64::max);
        self.weights.clear();
        self.weights.extend(weights.iter().zip(sharpness).map(|(w, s)| w * s));
        let sharp = self.weights.iter().copied().fold(0.0, f64::max);
        self.share(points, normal, 0.0, order);
        if sharp < most {
            self.weights.copy_from_slice(weights);
            self.share(points, normal, sharp, order);
        }
        // Rounding alone lets a hull of corners that lie in one place turn by less than it must.
        let total: f64 = self.capacity.iter().sum();
        if let Some(heaviest) = weights.iter().position(|w| *w == most) {
            self.capacity[heaviest] += (most - total).max(0.0);
        }
        weights.copy_from_slice(&self.capacity);
    }

    /// Shares out the layers of the scratch weights above `least`.
    fn share(&mut self, points: &[DVec3], normal: DVec3, least: f64, order: &mut [u16]) {
        let mut count = 0;
        for (i, w) in self.weights.iter().enumerate() {
            if *w > least {
                // Insertion sort, heaviest first: a dozen points, no allocation.
                let mut j = count;
                while j > 0 && self.weights[order[j - 1] as usize] < *w {
                    order[j] = order[j - 1];
                    j -= 1;
                }
                order[j] = i as u16;
                count += 1;
            }
        }
        let order = &order[..count];
        self.ring.clear();
        let from_first = |k: &u16| points[*k as usize].distance_squared(points[order[0] as usize]);
        let same = SAME_PLACE * SAME_PLACE * order.iter().map(from_first).fold(0.0, f64::max);
        for (i, k) in order.iter().enumerate() {
            if self.ring.iter().all(|m| points[*m as usize].distance_squared(points[*k as usize]) > same) {
                self.widen(points, normal, *k);
            }
            let lighter = order.get(i + 1).map_or(least, |m| self.weights[*m as usize]);
            let layer = self.weights[*k as usize] - lighter;
            if layer > 0.0 {
                self.share_out(points, normal, layer);
            }
        }
    }

    /// Takes one more contact into the hull.
    fn widen(&mut self, points: &[DVec3], normal: DVec3, k: u16) {
        let ring = &mut self.ring;
        let at = |i: u16| points[i as usize];
        let p = at(k);
        match ring.as_slice() {
            [] => ring.push(k),
            [_] => ring.push(k),
            [q, r] if is_on_line(normal, [at(*q), at(*r)], p) => {
                let (along, way) = (at(*r) - at(*q), p - at(*q));
                if way.dot(along) < 0.0 {
                    ring[0] = k;
                } else if way.dot(along) > along.length_squared() {
                    ring[1] = k;
                }
            }
            _ => {
                let n = ring.len();
                let next = |i: usize| if i + 1 == n { 0 } else { i + 1 };
                // Twice the area between a side and the contact, `< 0` if the contact lies beyond.
                let area = |ring: &[u16], i: usize| {
                    let (from, to) = (at(ring[i]), at(ring[next(i)]));
                    normal.dot((to - from).cross(p - from))
                };
                // From the side that it sees best: along a line of contacts rounding tells what it sees of each.
                let best = (0..n).map(|i| (area(ring, i), i)).min_by(|a, b| a.0.total_cmp(&b.0));
                let Some((_, best)) = best.filter(|(area, _)| *area < 0.0) else { return };
                let before = (1..n).take_while(|k| area(ring, (best + n - k) % n) < 0.0).count();
                // The corners between the sides that it sees make room for it.
                ring.rotate_left((best + n - before) % n);
                let sees = |i: usize| area(ring, i) < 0.0;
                let last = (1..n).take_while(|i| sees(*i)).last().unwrap_or(0);
                ring.drain(1..=last);
                ring.insert(1, k);
            }
        }
    }

    /// Gives each corner of the hull its part of a layer.
    fn share_out(&mut self, points: &[DVec3], normal: DVec3, layer: f64) {
        let Self { ring, corner, capacity, .. } = self;
        let n = ring.len();
        let at = |i: usize| points[ring[i] as usize];
        corner.clear();
        let mut extent = 0.0_f64;
        for i in 0..n {
            let [before, here, after] = [at((i + n - 1) % n), at(i), at((i + 1) % n)];
            corner.push(if n > 2 { corner_of(here - before, after - here, normal) } else { 1.0 });
            extent = (0..i).map(|j| at(j).distance_squared(here)).fold(extent, f64::max);
        }
        let reach2 = CROWDED * CROWDED * extent;
        for i in 0..n {
            let beside = |j: usize| {
                let way2 = at(i).distance_squared(at(j));
                if way2 < reach2 { corner[j] * (1.0 - (way2 / reach2).sqrt()) } else { 0.0 }
            };
            let crowd: f64 = corner[i] + (0..n).filter(|j| *j != i).map(beside).sum::<f64>();
            capacity[ring[i] as usize] += layer * corner[i] / crowd.max(1.0);
        }
    }
}

/// Whether three places lie on one line but for rounding.
fn is_on_line(normal: DVec3, [from, to]: [DVec3; 2], p: DVec3) -> bool {
    let (along, way) = (to - from, p - from);
    normal.dot(along.cross(way)).abs() <= 1e-9 * along.length_squared().max(way.length_squared())
}

/// By how much a border that comes along `before` and goes on along `after` turns to the left, as a part of [`CORNER`], at most 1.
fn corner_of(before: DVec3, after: DVec3, normal: DVec3) -> f64 {
    let (along, across) = (before.dot(after), normal.dot(before.cross(after)));
    if across <= along { ((across / along).atan() / CORNER).clamp(0.0, 1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(points: &[DVec3], weights: &[f64]) -> Vec<f64> {
        let mut w = weights.to_vec();
        Shares::new(16).spread(points, DVec3::Z, &mut w, &[1.0; 16][..points.len()], &mut [0; 16]);
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
    fn what_lies_within_the_hull_of_the_heavier_or_on_its_border_weighs_nothing() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let within = [DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.5, 0.0, 0.0), DVec3::new(1.0, 0.3, 0.0)];
        let found = spread(&[&square[..], &within].concat(), &[1.0, 0.8, 0.7, 0.6, 0.5, 0.5, 0.5]);
        assert!(found[4..].iter().all(|w| *w < 1e-12), "{found:?}");
        assert!(found.iter().zip([1.0, 0.8, 0.7, 0.6]).all(|(w, own)| (w - own).abs() < 1e-12), "{found:?}");
        // On a side it comes to weigh little by little, as it moves out.
        let out =
            |by: f64| spread(&[&square[..], &[DVec3::new(0.5, -by, 0.0)]].concat(), &[1.0, 1.0, 1.0, 1.0, 0.5])[4];
        assert!(out(1e-9) < 1e-7 && (out(0.01) - 0.5 * 0.2).abs() < 1e-3 && out(0.1) == 0.5, "{}", out(0.01));
        // Contacts along a line: its ends.
        let line = [2.0, 1.0, 0.0, -1.0, 3.0].map(|x| DVec3::X * x);
        assert_eq!(spread(&line, &[1.0, 0.9, 0.8, 0.7, 0.4])[4], 0.4);
    }

    /// An edge over two sides of a face: its ends and the two crossings lie on one line but for rounding.
    #[test]
    fn what_rounding_says_of_contacts_on_a_line_does_not_matter() {
        let z = 0.008_058_090_815_212_94;
        let places = |corner: f64, ys: [f64; 2], x: f64| {
            [
                DVec3::new(corner, corner, z),
                DVec3::new(corner, ys[0], z),
                DVec3::new(x, corner, z),
                DVec3::new(0.020_360_634_635_104_662, 0.012_843_914_038_974_736, z),
                DVec3::new(0.001_939_653_983_032_825_4, ys[1], z),
            ]
        };
        let ys = [0.012_996_400_974_220_203, 0.020_632_846_688_317_344];
        let whole = places(0.02, ys, 0.003_436_348_989_402_594_2);
        let cut = places(0.020_000_000_000_000_004, [0.012_996_400_974_220_201, ys[1]], 0.003_436_348_989_402_584);
        let weights = [1.0, 1.0, 1.0, 0.639_365_364_895_349_2, 0.367_153_311_682_667_96];
        let [expected, found] = [whole, cut].map(|p| spread(&p, &weights));
        assert!(expected[1] < 0.5 && expected[2] < 0.7, "the ends of the line take over: {expected:?}");
        assert!(expected.iter().zip(&found).all(|(w, f)| (w - f).abs() < 1e-6), "{expected:?} {found:?}");
    }

    #[test]
    fn a_crowd_never_weighs_less_than_its_heaviest() {
        for n in 2..12_u32 {
            let place = |i: u32| DVec3::new(f64::from(i * i) / 50.0, f64::from((i * 5) % n) * 0.1, 0.0);
            let points: Vec<DVec3> = (0..n).map(place).collect();
            let weights: Vec<f64> = (0..n).map(|i| 1.0 / f64::from(1 + (i * 7) % n)).collect();
            let total: f64 = spread(&points, &weights).iter().sum();
            assert!(total >= 1.0 - 1e-12 && total <= weights.iter().sum::<f64>() + 1e-12, "{n}: {total}");
        }
    }
}
