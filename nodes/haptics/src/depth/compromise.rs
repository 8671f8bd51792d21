//! Where planes leave no room between them: the point that they agree on best.

use crate::projection::Row;
use crate::solid::OnePlane;
use spatial::{DMat3, DVec3};

/// How much more the square of a violation weighs than the square of the way.
const WEIGHT: f64 = 100.0;
/// Rounds of Newton's method, which needs one for each set of violated rows that it comes by.
const ROUNDS: usize = 32;
/// How often a step that leads too far is halved at most.
const HALVINGS: usize = 32;

/// What the rows agree on best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compromise {
    /// Where `|z|^2 + WEIGHT sum violation^2` is least; rows across each other that can be met are met.
    pub z: DVec3,
    least: DVec3,
}

impl Compromise {
    /// Exists whatever the rows ask, and is continuous in them. Normals are of length one; equal rows count once. `violated` says
    /// which rows were so the last time: if they are again, nothing is searched.
    pub fn of(rows: &[Row<3>], violated: &mut u64) -> Self {
        if rows.len() <= 64 {
            let (h, g) = asked_by(rows, *violated);
            let least = h.inverse() * g;
            if *violated == violated_at(rows, least) {
                return Self::at(least);
            }
        }
        Self::search(rows, violated)
    }

    #[cold]
    #[inline(never)]
    fn search(rows: &[Row<3>], violated: &mut u64) -> Self {
        let mut least = DVec3::ZERO;
        let mut there = Pull::at(rows, least);
        for _ in 0..ROUNDS {
            let mut next = there.h.inverse() * there.g;
            let mut pull = Pull::at(rows, next);
            // The same rows ask for the same place again.
            let mut is_last = pull.violated == there.violated && rows.len() <= 64;
            // Each round must come nearer: else the rounds may go in circles.
            for _ in 0..HALVINGS {
                if !(pull.cost > there.cost) {
                    break;
                }
                next = next.midpoint(least);
                pull = Pull::at(rows, next);
                is_last = false;
            }
            let way = next.distance(least);
            (least, there) = (next, pull);
            if is_last || way <= 1e-12 {
                break;
            }
        }
        *violated = there.violated;
        Self::at(least)
    }

    fn at(least: DVec3) -> Self {
        Self { z: least * (1.0 + 1.0 / WEIGHT), least }
    }

    /// The row's multiplier: `z = sum multiplier_i normal_i`.
    #[inline]
    pub fn multiplier(&self, row: &Row<3>) -> f64 {
        (WEIGHT + 1.0) * violation(row, self.least).max(0.0)
    }
}

/// What the rows that are violated somewhere ask for.
struct Pull {
    /// `|z|^2 + WEIGHT sum violation^2` there.
    cost: f64,
    /// While the same rows are violated it is least where `h z = g`.
    h: DMat3,
    g: DVec3,
    /// Which of the first 64 rows are violated.
    violated: u64,
}

impl Pull {
    fn at(rows: &[Row<3>], z: DVec3) -> Self {
        let mut squares = 0.0;
        let mut pull = Self { cost: 0.0, h: DMat3::IDENTITY, g: DVec3::ZERO, violated: 0 };
        for (i, row) in rows.iter().enumerate() {
            let v = violation(row, z);
            if v > 0.0 && counts(rows, i) {
                (pull.h, pull.g) = with_row((pull.h, pull.g), row);
                pull.violated |= 1 << (i % 64);
                squares += v * v;
            }
        }
        pull.cost = z.length_squared() + WEIGHT * squares;
        pull
    }
}

/// The same `h` and `g` for any set of rows.
fn asked_by(rows: &[Row<3>], set: u64) -> (DMat3, DVec3) {
    let chosen = rows.iter().enumerate().filter(|(i, _)| set >> i & 1 != 0);
    chosen.fold((DMat3::IDENTITY, DVec3::ZERO), |sum, (_, row)| with_row(sum, row))
}

#[inline]
fn with_row((h, g): (DMat3, DVec3), row: &Row<3>) -> (DMat3, DVec3) {
    let n = DVec3::from_array(row.normal);
    let m = n * WEIGHT;
    (h + DMat3::from_cols(m * n.x, m * n.y, m * n.z), g + m * row.offset)
}

/// Which of up to 64 rows are violated.
fn violated_at(rows: &[Row<3>], z: DVec3) -> u64 {
    let is_in = |(i, row): &(usize, &Row<3>)| violation(row, z) > 0.0 && counts(rows, *i);
    rows.iter().enumerate().filter(is_in).fold(0, |set, (i, _)| set | 1 << i)
}

/// Whether no row before the `i`-th is equal to it.
fn counts(rows: &[Row<3>], i: usize) -> bool {
    !rows[..i].iter().any(|r| is_equal(r, &rows[i]))
}

fn violation(row: &Row<3>, z: DVec3) -> f64 {
    row.offset - DVec3::from_array(row.normal).dot(z)
}

fn is_equal(r: &Row<3>, s: &Row<3>) -> bool {
    let plane = |r: &Row<3>| (DVec3::from_array(r.normal), r.offset);
    OnePlane::EXACT.holds(plane(r), plane(s))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn row(normal: DVec3, offset: f64) -> Row<3> {
        Row { normal: normal.to_array(), offset, equality: false }
    }

    #[test]
    fn between_walls_too_close_it_is_the_middle_and_on_the_floor() {
        // Walls that ask for x >= 3 and x <= 1, one of them in two pieces; a floor; a ceiling that asks nothing.
        let rows = [
            row(DVec3::X, 3.0),
            row(DVec3::NEG_X, -1.0),
            row(DVec3::NEG_X, -1.0),
            row(DVec3::Z, 0.5),
            row(DVec3::NEG_Z, -9.0),
        ];
        let found = Compromise::of(&rows, &mut 0);
        assert!((found.z - DVec3::new(2.0, 0.0, 0.5)).length() < 0.03, "{}", found.z);
        assert!((found.z.z - 0.5).abs() < 1e-12 && found.z.y == 0.0);
        let pushes = [0, 1, 3].map(|i| found.multiplier(&rows[i]));
        assert!((pushes[0] - pushes[1] - found.z.x).abs() < 1e-9 && pushes.iter().all(|p| *p > 0.0), "{pushes:?}");
        assert_eq!(found.multiplier(&rows[4]), 0.0);
    }

    #[test]
    fn the_search_does_not_go_in_circles() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        for i in 0..3000 {
            let mut number = |least: f64| rng.random_range(least..1.0);
            let rows: Vec<Row<3>> = (0..1 + i % 7)
                .map(|_| row(DVec3::new(number(-1.0), number(-1.0), number(-1.0)).normalize(), 1e-3 * number(-0.5)))
                .collect();
            let found = Compromise::of(&rows, &mut 0);
            // Where it is least it has no slope.
            let slope = rows.iter().map(|r| DVec3::from_array(r.normal) * found.multiplier(r)).sum::<DVec3>();
            assert!(slope.distance(found.z) < 1e-13, "{rows:?}: {found:?}");
        }
    }

    #[test]
    fn rows_violated_the_last_time_lead_where_a_search_leads() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        let (mut violated, mut again) = (0, 0);
        let mut rows = Vec::new();
        for i in 0..3000 {
            if i % 30 == 0 {
                let normal = |_| DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0))).normalize();
                rows = (0..1 + i / 30 % 7).map(normal).map(|n| row(n, 0.0)).collect();
                // The same plane twice.
                rows.extend(rows.first().copied());
            }
            for r in &mut rows {
                r.offset += rng.random_range(-1e-4..1.1e-4);
            }
            let last = rows.len() - 1;
            rows[last] = rows[0];
            let mut anew = 0;
            let searched = Compromise::of(&rows, &mut anew);
            again += usize::from(violated == anew);
            let found = Compromise::of(&rows, &mut violated);
            assert!(found.z.distance(searched.z) < 1e-15, "{rows:?}: {found:?}, not {searched:?}");
            assert_eq!(violated, anew);
        }
        assert!((2000..2990).contains(&again), "{again}");
    }

    #[test]
    fn rows_across_each_other_are_met() {
        let rows = [row(DVec3::X, 1e-3), row(DVec3::Y, 2e-3)];
        let found = Compromise::of(&rows, &mut 0);
        assert!((found.z - DVec3::new(1e-3, 2e-3, 0.0)).length() < 1e-15, "{}", found.z);
        assert!((found.multiplier(&rows[1]) - 2e-3).abs() < 1e-15);
    }
}
