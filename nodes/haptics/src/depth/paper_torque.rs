//! The torque of several simultaneous contacts as the paper writes it: equations (4) to (6).

use crate::FormationKind;
use spatial::DVec3;

/// Components smaller than this part of the largest possible torque count as zero in rule (5).
const ZERO: f64 = 1e-9;

/// Torque (N.m, axes of W, about `x0`) of `force` (N, along `normal`) acting at the contacts `points` (metres, W, in one
/// contact plane up to rounding), paper section IV-B; and the kind of contact the points make.
///
/// `hull` is scratch with room for all points. One point: equation (3). On a line: edge-face. Else: face-face.
pub(crate) fn torque(
    points: &[DVec3],
    normal: DVec3,
    force: DVec3,
    x0: DVec3,
    hull: &mut Vec<DVec3>,
) -> (DVec3, FormationKind) {
    convex_hull(points, normal, hull);
    match hull.as_slice() {
        [] => (DVec3::ZERO, FormationKind::Free),
        [p] => (force.cross(x0 - *p), FormationKind::VertexFace),
        [p, q] => (edge_rule(hull, *q - *p, normal, force, x0), FormationKind::EdgeFace),
        _ => (face_rule(hull, normal, force, x0), FormationKind::FaceFace),
    }
}

/// Rules (5) and (6) with the contact frame's x axis along `x_axis`, of any length; `tau^z = 0` by construction (4).
fn edge_rule(points: &[DVec3], x_axis: DVec3, normal: DVec3, force: DVec3, x0: DVec3) -> DVec3 {
    let z_axis = normal;
    // The segment may lean out of the contact plane by rounding.
    let x_axis = (x_axis - z_axis * x_axis.dot(z_axis)).normalize();
    let y_axis = z_axis.cross(x_axis);
    let k = points.len() as f64;
    let least2 = ZERO * ZERO * force.length_squared();
    let (mut sum_x, mut sum_y, mut positive, mut negative, mut zero) = (0.0, 0.0, false, false, false);
    for p in points {
        let arm = x0 - *p;
        let tau = force.cross(arm);
        let (tx, ty) = (tau.dot(x_axis), tau.dot(y_axis));
        sum_x += tx;
        sum_y += ty;
        let is_zero = ty * ty <= least2 * arm.length_squared();
        positive |= ty > 0.0 && !is_zero;
        negative |= ty < 0.0 && !is_zero;
        zero |= is_zero;
    }
    // Signs differ also where one torque is zero and another is not.
    let differ = u8::from(positive) + u8::from(negative) + u8::from(zero) > 1;
    x_axis * (sum_x / k) + if differ { DVec3::ZERO } else { y_axis * (sum_y / k) }
}

/// Zero while the contact reference point lies in H; else rules (5) and (6) in the frame of H's nearest edge.
fn face_rule(hull: &[DVec3], normal: DVec3, force: DVec3, x0: DVec3) -> DVec3 {
    let n = hull.len();
    let reference = x0 - normal * (x0 - hull[0]).dot(normal);
    let mut inside = true;
    let mut nearest = (f64::INFINITY, DVec3::X);
    for i in 0..n {
        let (p, q) = (hull[i], hull[(i + 1) % n]);
        let along = q - p;
        let length = along.length();
        inside &= normal.cross(along).dot(reference - p) >= -ZERO * length * length;
        let t = ((reference - p).dot(along) / (length * length)).clamp(0.0, 1.0);
        let distance = reference.distance(p + along * t);
        if distance < nearest.0 {
            nearest = (distance, along / length);
        }
    }
    if inside { DVec3::ZERO } else { edge_rule(hull, nearest.1, normal, force, x0) }
}

/// Corners of the convex hull, counter-clockwise about `normal`, without duplicates and without points along an edge;
/// two ends if the points lie on a line. Monotone chain (Andrew 1979).
pub(crate) fn convex_hull(points: &[DVec3], normal: DVec3, hull: &mut Vec<DVec3>) {
    hull.clear();
    let [first, others @ ..] = points else { return };
    let size = others.iter().map(|p| p.distance_squared(*first)).fold(0.0, f64::max).sqrt();
    let same = 1e-8 * size;
    if size <= 1e-12 {
        hull.push(*first);
        return;
    }
    if let [second] = others {
        hull.extend([*first, *second]);
        return;
    }
    let (u, v) = normal.any_orthonormal_pair();
    // Gift wrapping: few points, and it needs no sorted copy.
    let before = |p: DVec3, q: DVec3| {
        let d = p - q;
        d.dot(u) < -same || (d.dot(u) <= same && d.dot(v) < 0.0)
    };
    let mut start = *first;
    for p in points {
        if before(*p, start) {
            start = *p;
        }
    }
    let mut at = start;
    for _ in 0..points.len() {
        if hull.len() == hull.capacity() {
            break;
        }
        hull.push(at);
        let mut next = None;
        for p in points {
            let d = *p - at;
            if d.length() <= same {
                continue;
            }
            let better = match next {
                None => true,
                Some(n) => {
                    let e: DVec3 = n - at;
                    let turn = normal.dot(e.cross(d));
                    let line = 1e-8 * e.length() * d.length();
                    turn < -line || (turn <= line && d.dot(e) > 0.0 && d.length_squared() > e.length_squared())
                }
            };
            if better {
                next = Some(*p);
            }
        }
        match next {
            Some(p) if p.distance(start) > same => at = p,
            _ => break,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tau(points: &[DVec3], x0: DVec3) -> (DVec3, FormationKind) {
        torque(points, DVec3::Z, DVec3::new(0.0, 0.0, 2.0), x0, &mut Vec::with_capacity(16))
    }

    #[test]
    fn figure_4_edge_face_has_torque_about_the_edge_only() {
        // Contact edge along x; x0 beside it and between its ends: as drawn, tau^y of the two contacts differ in sign.
        let ends = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 0.0)];
        let x0 = DVec3::new(0.5, -0.3, 1.0);
        let (t, kind) = tau(&ends, x0);
        assert_eq!(kind, FormationKind::EdgeFace);
        // (6): F x (x0 - App) = 2 z x (., -0.3, .) = (0.6, ., 0): positive about the edge, zero along y.
        assert!((t - DVec3::new(0.6, 0.0, 0.0)).length() < 1e-15, "{t}");
    }

    #[test]
    fn rule_5_beyond_the_end_is_the_mean() {
        let ends = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 0.0)];
        let (t, _) = tau(&ends, DVec3::new(3.0, 0.0, 1.0));
        // tau^y_k = 2 (x0 - App_k).x = 8 and 2: mean 5.
        assert!((t - DVec3::new(0.0, 5.0, 0.0)).length() < 1e-15, "{t}");
    }

    #[test]
    fn rule_5_counts_the_sign_of_zero_as_differing() {
        let ends = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 0.0)];
        let (t, _) = tau(&ends, DVec3::new(2.0, 0.0, 1.0));
        assert_eq!(t, DVec3::ZERO);
    }

    #[test]
    fn figure_5_right_inside_is_zero() {
        let h = [
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(1.0, 0.0, 0.0),
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
        ];
        assert_eq!(tau(&h, DVec3::new(0.4, 0.7, 3.0)), (DVec3::ZERO, FormationKind::FaceFace));
        assert_eq!(tau(&h, DVec3::new(1.0, 0.7, 3.0)).0, DVec3::ZERO, "the border belongs to H");
    }

    #[test]
    fn figure_5_left_outside_turns_about_the_nearest_edge() {
        // A quadrangle of contacts #1 to #4; the reference point lies beyond edge #1-#2, along x, between its ends.
        let h = [
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(1.0, 0.0, 0.0),
            DVec3::new(1.2, 1.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
        ];
        let (t, kind) = tau(&h, DVec3::new(0.4, -0.5, 1.0));
        assert_eq!(kind, FormationKind::FaceFace);
        // (6): 2 (App_k.y - x0.y) over k = 1, 1, 3, 3, mean 2; (5): zero.
        assert!((t - DVec3::new(2.0, 0.0, 0.0)).length() < 1e-12, "{t}");
    }

    #[test]
    fn hull_drops_duplicates_and_points_along_edges() {
        let mut hull = Vec::with_capacity(16);
        let p = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 1.0), (0.4, 0.4), (0.0, 1.0), (0.0, 0.5)];
        convex_hull(&p.map(|(x, y)| DVec3::new(x, y, 0.0)), DVec3::Z, &mut hull);
        assert_eq!(hull.len(), 4);
        convex_hull(&p.map(|(x, _)| DVec3::new(x, x, 0.0)), DVec3::Z, &mut hull);
        assert_eq!(hull.len(), 2);
    }
}
