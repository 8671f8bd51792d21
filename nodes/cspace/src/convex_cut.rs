use spatial::DVec3;

/// The parts of a convex polygon where `height` is not positive, and where it is. `height` must be affine in the point;
/// its unit does not matter. A part of fewer than three corners is empty.
#[must_use]
pub fn split_polygon(polygon: &[DVec3], height: impl Fn(DVec3) -> f64) -> (Vec<DVec3>, Vec<DVec3>) {
    let (mut below, mut above) = (Vec::with_capacity(polygon.len() + 1), Vec::new());
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (hp, hq) = (height(*p), height(q));
        if hp <= 0.0 {
            below.push(*p)
        } else {
            above.push(*p)
        }
        if (hp <= 0.0) != (hq <= 0.0) {
            let crossing = *p + (q - *p) * (hp / (hp - hq));
            below.push(crossing);
            above.push(crossing);
        }
    }
    (below, above)
}

/// A convex polygon without the convex region where all `heights` are not positive: the convex parts outside, which do
/// not overlap, and what was cut out (fewer than three corners: nothing, and the polygon comes back in one part).
///
/// For each height in turn what lies beyond it is outside; what lies beyond none is inside.
#[must_use]
pub fn cut_out(polygon: Vec<DVec3>, heights: &[impl Fn(DVec3) -> f64]) -> (Vec<Vec<DVec3>>, Vec<DVec3>) {
    // One that is not cut at all must not come back in pieces.
    if heights.iter().any(|height| polygon.iter().all(|p| height(*p) > 0.0)) {
        return (vec![polygon], Vec::new());
    }
    let mut outside = Vec::new();
    let mut inner = polygon.clone();
    for height in heights {
        let (below, beyond) = split_polygon(&inner, height);
        if beyond.len() > 2 {
            outside.push(beyond);
        }
        inner = below;
        if inner.len() < 3 {
            return (vec![polygon], Vec::new());
        }
    }
    (outside, inner)
}

/// Area of a flat polygon across the unit vector `normal`, in the square of the corners' unit; positive if they run
/// counter-clockwise seen from its tip.
#[must_use]
pub fn polygon_area(polygon: &[DVec3], normal: DVec3) -> f64 {
    let Some(first) = polygon.first() else { return 0.0 };
    0.5 * polygon.windows(2).map(|w| (w[0] - *first).cross(w[1] - *first).dot(normal)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];

    /// Inside of the box from `low` to `high` in x and y.
    fn sides(low: [f64; 2], high: [f64; 2]) -> [impl Fn(DVec3) -> f64; 4] {
        [0, 1, 2, 3].map(move |side| {
            move |p: DVec3| match side {
                0 => low[0] - p.x,
                1 => p.x - high[0],
                2 => low[1] - p.y,
                _ => p.y - high[1],
            }
        })
    }

    #[test]
    fn a_hole_leaves_the_rest() {
        let (outside, inner) = cut_out(SQUARE.to_vec(), &sides([0.25, 0.25], [0.5, 0.75]));
        let left: f64 = outside.iter().map(|part| polygon_area(part, DVec3::Z)).sum();
        assert!((polygon_area(&inner, DVec3::Z) - 0.125).abs() < 1e-15 && (left - 0.875).abs() < 1e-15);
        assert!(outside.iter().all(|part| polygon_area(part, DVec3::Z) > 0.0), "every part runs the same way around");
    }

    #[test]
    fn what_is_beside_cuts_nothing_and_what_covers_leaves_nothing() {
        let (outside, inner) = cut_out(SQUARE.to_vec(), &sides([0.2, 1.5], [0.8, 2.0]));
        assert!(outside == vec![SQUARE.to_vec()] && inner.is_empty());
        let (outside, inner) = cut_out(SQUARE.to_vec(), &sides([-1.0, -1.0], [2.0, 2.0]));
        assert!(outside.is_empty() && inner == SQUARE);
        // Beside a corner no single side parts the two.
        let beyond = |p: DVec3| 2.1 - p.x - p.y;
        let (outside, inner) = cut_out(SQUARE.to_vec(), &[beyond]);
        assert!(outside == vec![SQUARE.to_vec()] && inner.is_empty());
    }
}
