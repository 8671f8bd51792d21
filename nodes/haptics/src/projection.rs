//! The nearest point of a polyhedron to the origin: the quadratic program behind corners and proxy.
#![expect(clippy::needless_range_loop, reason = "matrices and vectors walked by one index, as in the formulas")]

mod direct;

/// One inequality `normal . z >= offset`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<const N: usize> {
    /// Need not be of unit length; its length says how the violation (metres) grows with `z`.
    pub normal: [f64; N],
    /// Metres.
    pub offset: f64,
    /// Holds with equality, its multiplier has any sign.
    pub equality: bool,
}

/// Violations up to this count as satisfied, metres.
const TOLERANCE: f64 = 1e-12;
/// A row whose part outside the span of the active rows is shorter than this fraction is dependent on them.
const DEPENDENT: f64 = 1e-7;

/// `argmin |z|^2` subject to the rows, by the dual active-set method (Goldfarb and Idnani 1983).
///
/// The dual method starts at the unconstrained minimum, so it needs no feasible start; each step adds the most violated
/// row. At most `N` rows are active at once. Bounded, without allocation. Rows that contradict the active ones are left
/// violated and counted: the caller checks the pose it gets in any case.
#[derive(Clone, Debug)]
pub(crate) struct Projection<const N: usize> {
    /// The minimiser.
    pub z: [f64; N],
    active: [usize; N],
    multiplier: [f64; N],
    count: usize,
    /// Orthonormal basis of the active normals, and their coordinates in it (upper triangular).
    basis: [[f64; N]; N],
    upper: [[f64; N]; N],
    /// Rows left violated.
    pub contradictions: u32,
}

/// In two sums, which the processor adds side by side.
#[inline]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut s = [0.0; 2];
    for i in 0..N / 2 {
        s[0] += a[2 * i] * b[2 * i];
        s[1] += a[2 * i + 1] * b[2 * i + 1];
    }
    if N % 2 == 1 {
        s[0] += a[N - 1] * b[N - 1];
    }
    s[0] + s[1]
}

impl<const N: usize> Projection<N> {
    pub const fn new() -> Self {
        Self {
            z: [0.0; N],
            active: [0; N],
            multiplier: [0.0; N],
            count: 0,
            basis: [[0.0; N]; N],
            upper: [[0.0; N]; N],
            contradictions: 0,
        }
    }

    /// The active rows and their multipliers: `z = sum multiplier_i normal_i`.
    pub fn active(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        (0..self.count).map(|k| (self.active[k], self.multiplier[k]))
    }

    /// `|z|^2` of the minimiser.
    pub fn way_squared(&self) -> f64 {
        dot(&self.z, &self.z)
    }

    /// Solves anew. `rows` of 64 or fewer are all honoured; further ones are looked at, too, but may be left violated.
    pub fn solve(&mut self, rows: &[Row<N>]) {
        self.count = 0;
        self.solve_again(rows);
    }

    /// Solves for rows that resemble the last ones: starts from those that were active and still push. The minimiser is the
    /// same; where rows depend on each other, the last ones keep carrying.
    pub fn solve_again(&mut self, rows: &[Row<N>]) {
        self.z = [0.0; N];
        self.contradictions = 0;
        self.resume(rows);
        let mut refused = [usize::MAX; 8];
        let mut refused_count = 0;
        for (i, row) in rows.iter().enumerate().filter(|(_, r)| r.equality) {
            if !self.add(i, row, rows) {
                self.contradictions += 1;
            }
        }
        // Each round either adds a row or refuses one; cycling is impossible in exact arithmetic, bounded in floating point.
        for _ in 0..8 * N {
            let mut worst = -TOLERANCE;
            let mut pick = None;
            for (i, row) in rows.iter().enumerate() {
                let slack = dot(&row.normal, &self.z) - row.offset;
                if slack < worst
                    && !row.equality
                    && !self.active[..self.count].contains(&i)
                    && !refused[..refused_count].contains(&i)
                {
                    worst = slack;
                    pick = Some(i);
                }
            }
            let Some(i) = pick else { return };
            if !self.add(i, &rows[i], rows) {
                self.contradictions += 1;
                if refused_count == refused.len() {
                    return;
                }
                refused[refused_count] = i;
                refused_count += 1;
            }
        }
    }

    /// The minimiser with the last active rows as equations, if they are independent and all of them push: that is where
    /// the dual method would stand after adding just them. Those that would pull are left out, once; else none is active.
    fn resume(&mut self, rows: &[Row<N>]) {
        let (known, known_count) = (self.active, self.count);
        let mut known = &known[..known_count];
        let mut pushing = [0; N];
        for _ in 0..2 {
            if !self.factor(known, rows) {
                break;
            }
            // rows = upper^T basis: upper^T y = offsets, z = basis^T y, upper multipliers = y.
            let mut y = [0.0; N];
            for k in 0..self.count {
                y[k] = rows[self.active[k]].offset;
                for j in 0..k {
                    y[k] -= self.upper[j][k] * y[j];
                }
                y[k] /= self.upper[k][k];
            }
            let mut count = 0;
            for k in (0..self.count).rev() {
                let mut m = y[k];
                for j in k + 1..self.count {
                    m -= self.upper[k][j] * self.multiplier[j];
                }
                self.multiplier[k] = m / self.upper[k][k];
            }
            for k in 0..self.count {
                if self.multiplier[k] > 0.0 {
                    pushing[count] = self.active[k];
                    count += 1;
                }
            }
            if count == self.count {
                for k in 0..self.count {
                    for j in 0..N {
                        self.z[j] += y[k] * self.basis[k][j];
                    }
                }
                return;
            }
            known = &pushing[..count];
        }
        self.count = 0;
    }

    /// Makes the rows active and orthogonalises their normals. False if one is no inequality any more or depends on the others.
    fn factor(&mut self, known: &[usize], rows: &[Row<N>]) -> bool {
        self.count = 0;
        for &i in known {
            let Some(row) = rows.get(i).filter(|r| !r.equality && r.offset.is_finite()) else { return false };
            let k = self.count;
            let mut outside = row.normal;
            for j in 0..k {
                let c = dot(&self.basis[j], &row.normal);
                self.upper[j][k] = c;
                for l in 0..N {
                    outside[l] -= c * self.basis[j][l];
                }
            }
            let rest = dot(&outside, &outside).sqrt();
            if !(rest > DEPENDENT * dot(&row.normal, &row.normal).sqrt()) {
                return false;
            }
            for l in 0..N {
                self.basis[k][l] = outside[l] / rest;
            }
            self.upper[k][k] = rest;
            self.active[k] = i;
            self.count += 1;
        }
        true
    }

    /// Makes row `i` active, dropping others where their multipliers would turn negative. False if it contradicts them.
    fn add(&mut self, i: usize, row: &Row<N>, rows: &[Row<N>]) -> bool {
        let length = dot(&row.normal, &row.normal).sqrt();
        if !(length > 0.0) || !row.offset.is_finite() {
            return false;
        }
        let mut lambda = 0.0;
        loop {
            let slack = dot(&row.normal, &self.z) - row.offset;
            // Split the normal: `coordinates` in the span of the active rows, `outside` orthogonal to it.
            let mut outside = row.normal;
            let mut coordinates = [0.0; N];
            for k in 0..self.count {
                coordinates[k] = dot(&self.basis[k], &row.normal);
                for j in 0..N {
                    outside[j] -= coordinates[k] * self.basis[k][j];
                }
            }
            let rest = dot(&outside, &outside);
            let dependent = self.count == N || rest.sqrt() <= DEPENDENT * length;
            if dependent && slack.abs() <= TOLERANCE {
                return true;
            }
            // r = (active normals)^+ normal: how the multipliers give way.
            let mut r = coordinates;
            for k in (0..self.count).rev() {
                for j in k + 1..self.count {
                    r[k] -= self.upper[k][j] * r[j];
                }
                r[k] /= self.upper[k][k];
            }
            // An equality may be violated on either side.
            let sign = if row.equality && slack > 0.0 { -1.0 } else { 1.0 };
            let mut dual_step = f64::INFINITY;
            let mut blocking = None;
            for k in 0..self.count {
                if sign * r[k] > 1e-14 && !rows[self.active[k]].equality {
                    let t = self.multiplier[k] / (sign * r[k]);
                    if t < dual_step {
                        dual_step = t;
                        blocking = Some(k);
                    }
                }
            }
            let primal_step = if dependent { f64::INFINITY } else { slack.abs() / rest };
            let t = dual_step.min(primal_step);
            if !t.is_finite() {
                return false;
            }
            if !dependent {
                for j in 0..N {
                    self.z[j] += sign * t * outside[j];
                }
            }
            for k in 0..self.count {
                self.multiplier[k] -= sign * t * r[k];
            }
            lambda += sign * t;
            if primal_step <= dual_step {
                let k = self.count;
                let scale = 1.0 / rest.sqrt();
                for j in 0..N {
                    self.basis[k][j] = outside[j] * scale;
                }
                for j in 0..k {
                    self.upper[j][k] = coordinates[j];
                }
                self.upper[k][k] = rest.sqrt();
                self.active[k] = i;
                self.multiplier[k] = lambda;
                self.count += 1;
                return true;
            }
            // `blocking` is set whenever the dual step is finite.
            let Some(k) = blocking else { return false };
            self.drop(k, rows);
        }
    }

    /// Takes active row `k` out and orthogonalises the rest anew: a few rows of six numbers.
    fn drop(&mut self, k: usize, rows: &[Row<N>]) {
        for j in k..self.count - 1 {
            self.active[j] = self.active[j + 1];
            self.multiplier[j] = self.multiplier[j + 1];
        }
        self.count -= 1;
        for m in k..self.count {
            let normal = rows[self.active[m]].normal;
            let mut outside = normal;
            for j in 0..m {
                let c = dot(&self.basis[j], &normal);
                self.upper[j][m] = c;
                for l in 0..N {
                    outside[l] -= c * self.basis[j][l];
                }
            }
            let length = dot(&outside, &outside).sqrt().max(f64::MIN_POSITIVE);
            self.upper[m][m] = length;
            for l in 0..N {
                self.basis[m][l] = outside[l] / length;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn row<const N: usize>(normal: [f64; N], offset: f64) -> Row<N> {
        Row { normal, offset, equality: false }
    }

    #[test]
    fn corner_of_two_planes_is_the_corner() {
        let mut p = Projection::<3>::new();
        p.solve(&[row([1.0, 0.0, 0.0], 2.0), row([0.0, 1.0, 0.0], 2.0), row([1.0, 0.0, 0.0], 2.0)]);
        assert!((p.z[0] - 2.0).abs() < 1e-15 && (p.z[1] - 2.0).abs() < 1e-15 && p.z[2] == 0.0);
        assert_eq!(p.active().count(), 2);
    }

    #[test]
    fn contradiction_is_counted_and_ends() {
        let mut p = Projection::<3>::new();
        p.solve(&[row([1.0, 0.0, 0.0], 1.0), row([-1.0, 0.0, 0.0], 1.0)]);
        assert_eq!(p.contradictions, 1);
    }

    #[test]
    fn random_programs_meet_the_optimality_conditions() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(7);
        let mut most_active = 0;
        for _ in 0..2000 {
            // Feasible by construction: every row admits the point `inside`.
            let inside: [f64; 6] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
            let rows: Vec<Row<6>> = (0..24)
                .map(|_| {
                    let normal: [f64; 6] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
                    row(normal, dot(&normal, &inside) - rng.random_range(0.0..0.2))
                })
                .collect();
            let mut p = Projection::<6>::new();
            p.solve(&rows);
            assert_eq!(p.contradictions, 0);
            let mut rebuilt = [0.0; 6];
            for (i, m) in p.active() {
                assert!(m >= -1e-10, "multiplier {m}");
                for j in 0..6 {
                    rebuilt[j] += m * rows[i].normal[j];
                }
            }
            for j in 0..6 {
                assert!((rebuilt[j] - p.z[j]).abs() < 1e-7, "{rebuilt:?} {:?}", p.z);
            }
            for r in &rows {
                assert!(dot(&r.normal, &p.z) - r.offset > -1e-8);
            }
            most_active = most_active.max(p.count);
        }
        assert!(most_active >= 5, "the programs should be hard enough to need many rows: {most_active}");
    }

    #[test]
    fn what_was_active_changes_nothing_but_the_way() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(11);
        let mut again = Projection::<6>::new();
        let mut kept = 0;
        let mut rows: Vec<Row<6>> = Vec::new();
        let mut inside = [0.0; 6];
        for i in 0..3000 {
            // New rows now and then, the old ones a little changed in between; feasible by construction.
            if i % 10 == 0 {
                inside = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
                rows = (0..16).map(|_| row(std::array::from_fn(|_| rng.random_range(-1.0..1.0)), 0.0)).collect();
            }
            for r in &mut rows {
                r.normal[i % 6] += rng.random_range(-0.01..0.01);
                r.offset = dot(&r.normal, &inside) - rng.random_range(0.0..0.02);
            }
            let mut anew = Projection::<6>::new();
            anew.solve(&rows);
            let before: Vec<usize> = again.active().map(|(k, _)| k).collect();
            again.solve_again(&rows);
            kept += usize::from(before.iter().all(|k| again.active().any(|(j, _)| j == *k)) && before.len() > 2);
            assert_eq!(anew.contradictions + again.contradictions, 0);
            for j in 0..6 {
                assert!((anew.z[j] - again.z[j]).abs() < 1e-8, "{i}: {:?} {:?}", anew.z, again.z);
            }
        }
        assert!(kept > 300, "the last active rows should often stay: {kept}");
    }

    #[test]
    fn equalities_hold_from_both_sides() {
        let mut p = Projection::<3>::new();
        let equal = Row { normal: [0.0, 1.0, 0.0], offset: -0.5, equality: true };
        p.solve(&[row([1.0, 0.0, 0.0], 1.0), equal]);
        assert!((p.z[1] + 0.5).abs() < 1e-15 && (p.z[0] - 1.0).abs() < 1e-15);
    }
}
