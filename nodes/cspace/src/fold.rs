//! Near the common side of two C-faces, both of them count.
//!
//! The proofs of the depth `e` leave the directions around Near's normal to the extent of the C-face: a disc of radius
//! `r` about the SCP, in the plane of Near, has a support of at least `e` in every direction at an angle `t` from the
//! normal with `e tan(t/2) <= r`. Close to a side that disc is small. But a disc of radius `r` about the nearest point
//! of the side, folded along it, half in Near and half in the C-face across, does the same where `e tan(t/2) <= r - s`,
//! with `s` the distance to the side. Let `T` be the angle of the fold, and `k` the cosine of the direction's azimuth
//! from the side's outward normal:
//! * `k <= 0`: Near's half gives `e cos t - s |k| sin t + r sin t`.
//! * `k > 0`, and the direction does not rise along the other half: the side itself gives
//!   `e cos t + (s k + r sqrt(1 - k^2)) sin t`, concave in `k`. That is enough at `k = 0`, and as `x` is no deeper
//!   under Near than under the other plane, `s >= e tan(T/2)`, also at `k = 1` while `t <= T`; for a larger `t` the case
//!   ends at `k = tan T / tan t`, where `s k + r sqrt(1 - k^2) >= e tan(t/2)` follows from the two inequalities.
//! * Else the other half gives `r sin t'`, with `t' <= t` the angle from its normal: together with `e cos t'` or more,
//!   less `s sin t'`, if `t'` is acute; if not, `sin t' >= sin t`, together with `e cos t` or more.

use crate::crossing::true_normal;
use crate::parallelogram::Parallelogram;
use crate::placed::Placed;
use crate::{BasicContact, CFace};
use spatial::DVec3;

/// The two sides of a C-face that a point of its plane is nearest to.
struct Nearest {
    /// How far the point lies beyond the nearest side and the next one, metres.
    beyond: [f64; 2],
    /// Outward normal of the nearest side in the C-face's plane, W.
    out_w: DVec3,
    /// The C-face across the nearest side.
    across: BasicContact,
}

/// Near's C-face and the one across its nearest side.
pub(crate) struct Fold {
    /// From the SCP to that side and to the next one of Near's C-face, metres.
    pub s: f64,
    pub at_home: f64,
    /// The C-face across, and how far the point of the side nearest to the SCP is from its other sides, metres.
    pub across: BasicContact,
    pub at_away: f64,
}

/// The largest of some numbers, the one after it, and the place of the largest.
fn two_largest(numbers: impl Iterator<Item = f64>) -> ([f64; 2], usize) {
    let (mut two, mut at) = ([f64::NEG_INFINITY; 2], 0);
    for (i, s) in numbers.enumerate() {
        if s > two[0] {
            (two, at) = ([s, two[0]], i);
        } else if s > two[1] {
            two[1] = s;
        }
    }
    (two, at)
}

impl Placed<'_> {
    /// What the disc about the SCP may count for, metres: see above. No neighbour of `near` is better, its sides lie `inside`
    /// metres or more from the SCP, and `x` is inside of its plane.
    pub(crate) fn folded_disc(&self, near: &CFace, inside: f64) -> f64 {
        match self.fold(near) {
            Some(fold) if fold.s >= 0.0 => inside.max((fold.at_home - fold.s).min(fold.at_away) - fold.s),
            _ => inside,
        }
    }

    /// The fold along the side of `near` that its SCP is nearest to; `x` is inside of its plane.
    pub(crate) fn fold(&self, near: &CFace) -> Option<Fold> {
        let home = self.nearest_sides(near.contact, DVec3::ZERO, Some(near.normal_w))?;
        let s = -home.beyond[0];
        let to_side = home.out_w * s - near.normal_w * near.distance;
        let away = self.nearest_sides(home.across, to_side, None)?;
        Some(Fold { s, at_home: -home.beyond[1], across: home.across, at_away: -away.beyond[1] })
    }

    /// The sides of an applicable node's C-face that `x + shift` is nearest to; and what lies across the first, if its normal is
    /// known. None where edges are too nearly parallel.
    fn nearest_sides(&self, node: BasicContact, shift: DVec3, normal_w: Option<DVec3>) -> Option<Nearest> {
        let across = normal_w.is_some();
        match node {
            BasicContact::TypeB { vertex_a: v, face_b: f } => {
                let p = self.point_in_w(self.a.points[v.index()]) + shift;
                let sides = self.b.sides(f.0);
                let (beyond, i) = two_largest(sides.iter().map(|s| s.out.dot(p) - s.offset));
                let side = sides.get(i)?;
                let next = if across { self.across_face_side::<false>(v.0, f.0, side.edge, side.face).0 } else { node };
                Some(Nearest { beyond, out_w: side.out, across: next })
            }
            BasicContact::TypeA { face_a: f, vertex_b: v } => {
                let q = self.point_in_a(self.b.points[v.index()] - shift);
                let sides = self.a.sides(f.0);
                let (beyond, i) = two_largest(sides.iter().map(|s| s.out.dot(q) - s.offset));
                let side = sides.get(i)?;
                let next = if across { self.across_face_side::<true>(v.0, f.0, side.edge, side.face).0 } else { node };
                Some(Nearest { beyond, out_w: -self.turn_to_w(side.out), across: next })
            }
            BasicContact::TypeC { edge_a: e, edge_b: g } => {
                let (rod_a, rod_b) = (&self.a.rods[e.index()], &self.b.rods[g.index()]);
                let u = self.turn_to_w(rod_a.dir);
                let n = match normal_w {
                    Some(n) => n,
                    None => true_normal(rod_b.faces.map(|f| self.b.planes[f as usize].0), u)?.normalize(),
                };
                let w = self.between_edges(e.0, g.0) + shift;
                let face = Parallelogram::new(n, w, (u, rod_a.length), (rod_b.dir, rod_b.length));
                let sides = [face.beyond_b[0], face.beyond_b[1], face.beyond_a[0], face.beyond_a[1]];
                let (beyond, i) = two_largest(sides.into_iter());
                let (at_b, end) = (i < 2, i % 2);
                let along = n.cross(if at_b { u } else { rod_b.dir });
                let inward = if at_b { along.dot(rod_b.dir) } else { -along.dot(u) };
                let out_w = if (inward < 0.0) == (end == 1) { -along } else { along };
                let next = match (across, at_b) {
                    (false, _) => node,
                    (true, true) => self.across_at_b(e.0, g.0, end, n, self.arc_at_b(e.0, g.0, end)).0,
                    (true, false) => self.across_at_a(e.0, g.0, end, n, self.arc_at_a(e.0, g.0, end)).0,
                };
                Some(Nearest { beyond, out_w, across: next })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::two_largest;

    /// The statement at the top, by trying: supports of folded discs in a grid of directions.
    #[test]
    fn a_folded_disc_is_as_good_as_a_flat_one() {
        let mut least = f64::INFINITY;
        for i in 0..7 {
            // Angle of the fold, distance to the side as small as it may be and larger, radius as small as it may be.
            let fold = 0.05 + 0.45 * f64::from(i);
            let normal = (fold.sin(), fold.cos());
            for extra in [0.0, 0.1, 2.0] {
                let s = (0.5 * fold).tan() + extra;
                for j in 1..60 {
                    let t = 0.05 * f64::from(j);
                    let r = s + (0.5 * t).tan();
                    for k in 0..=180 {
                        let (sin_k, cos_k) = f64::from(k).to_radians().sin_cos();
                        // The direction's parts outward, upward and along the side; e = 1.
                        let (out, up, along) = (t.sin() * cos_k, t.cos(), t.sin() * sin_k);
                        let flat = if out < 0.0 { t.sin() } else { along };
                        let rise = out * normal.1 - up * normal.0;
                        let other = if rise > 0.0 { rise.hypot(along) } else { along };
                        let support = up + s * out + r * flat.max(other);
                        least = least.min(support - 1.0);
                    }
                }
            }
        }
        assert!(least > -1e-12, "{least}");
        assert!(least < 1e-3, "some are just enough: {least}");
    }

    #[test]
    fn the_two_nearest_sides() {
        assert_eq!(two_largest([-3.0, -1.0, -2.0, -1.5].into_iter()), ([-1.0, -1.5], 1));
        assert_eq!(two_largest([-1.0, -1.0].into_iter()), ([-1.0, -1.0], 0));
    }
}
