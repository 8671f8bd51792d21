//! From tick to tick the same one, two or three planes push: where these meet is a matter of a few products.

use super::{Projection, Row, TOLERANCE};
use spatial::DVec3;

/// Planes that meet at a smaller sine than this, or three of them in a corner with a smaller determinant, are left to the basis.
const STEEP: f64 = 0.05;

impl Projection<3> {
    /// The same as [`Projection::solve_again`], in closed form where the planes that pushed still do and no other is violated: then there
    /// is no basis to be found.
    pub fn hold_again(&mut self, rows: &[Row<3>]) {
        if !self.holds_on(rows) {
            self.solve_again(rows);
        }
    }

    /// Whether that is so.
    fn holds_on(&mut self, rows: &[Row<3>]) -> bool {
        let known = &self.active[..self.count];
        let plane = |k: usize| {
            let row = rows.get(*known.get(k)?).filter(|r| !r.equality)?;
            Some((DVec3::from_array(row.normal), row.offset))
        };
        // z = sum m_i n_i lies in all planes.
        let (z, m) = match (plane(0), plane(1), plane(2)) {
            (Some((n, offset)), None, None) => {
                let m = offset / n.length_squared();
                (n * m, [m, 0.0, 0.0])
            }
            (Some((n0, o0)), Some((n1, o1)), None) => {
                let (a, b, c) = (n0.length_squared(), n0.dot(n1), n1.length_squared());
                let square = a * c - b * b;
                let [m0, m1] = [(c * o0 - b * o1) / square, (a * o1 - b * o0) / square];
                if !(square > STEEP * STEEP * a * c) {
                    return false;
                }
                (n0 * m0 + n1 * m1, [m0, m1, 0.0])
            }
            (Some((n0, o0)), Some((n1, o1)), Some((n2, o2))) => {
                let across = [n1.cross(n2), n2.cross(n0), n0.cross(n1)];
                let volume = n0.dot(across[0]);
                if !(volume.abs() > STEEP) {
                    return false;
                }
                let per = 1.0 / volume;
                let z = (across[0] * o0 + across[1] * o1 + across[2] * o2) * per;
                (z, across.map(|a| a.dot(z) * per))
            }
            _ => return false,
        };
        let pushes = m[..known.len()].iter().all(|m| *m > 0.0 && m.is_finite());
        let is_off = |(i, row): (usize, &Row<3>)| {
            known.contains(&i) || DVec3::from_array(row.normal).dot(z) - row.offset >= -TOLERANCE
        };
        if !pushes || !rows.iter().enumerate().all(is_off) {
            return false;
        }
        (self.z, self.multiplier, self.contradictions) = (z.to_array(), m, 0);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn planes_that_go_on_pushing_lead_where_a_search_leads() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(9);
        let mut direct = [0; 4];
        for _ in 0..3000 {
            let count = rng.random_range(1..6);
            let mut rows: Vec<Row<3>> = (0..count)
                .map(|_| {
                    let n = DVec3::from_array(std::array::from_fn(|_| rng.random_range(-1.0..1.0))).normalize();
                    Row { normal: n.to_array(), offset: rng.random_range(-0.2..1.0), equality: false }
                })
                .collect();
            let mut searched = Projection::<3>::new();
            searched.solve(&rows);
            let mut held = searched.clone();
            for row in &mut rows {
                row.offset += rng.random_range(-0.05..0.05);
                let turned = DVec3::from_array(row.normal.map(|n| n + rng.random_range(-0.05..0.05)));
                row.normal = turned.normalize().to_array();
            }
            searched.solve_again(&rows);
            if !held.holds_on(&rows) {
                continue;
            }
            direct[held.count] += 1;
            assert_eq!(searched.contradictions, 0, "{rows:?}");
            let distance = DVec3::from_array(held.z).distance(DVec3::from_array(searched.z));
            assert!(distance < 1e-11, "{rows:?}: {held:?}, not {searched:?}");
            let mut carried = DVec3::ZERO;
            for (i, m) in held.active() {
                carried += DVec3::from_array(rows[i].normal) * m;
            }
            assert!(carried.distance(DVec3::from_array(held.z)) < 1e-11, "{rows:?}: {held:?}");
        }
        assert!(direct[1..].iter().all(|n| *n > 100), "{direct:?}");
    }
}
