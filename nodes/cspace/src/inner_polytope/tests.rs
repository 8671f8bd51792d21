use super::*;

/// The support function on a circle of directions, by trying: of a pyramid, and of what it grows to.
#[test]
fn the_least_on_a_circle_is_found() {
    let n = DVec3::Z;
    let top = [(1.0, 0.3), (-0.4, 0.9), (-0.7, -0.5), (0.6, -0.8)].map(|(x, y)| DVec3::new(x, y, 0.2));
    let mut polytope = InnerPolytope::new();
    polytope.start(&top, DVec3::new(0.1, -0.2, -1.5), 4.0);
    for grown in [None, Some(DVec3::new(1.1, 0.9, -0.4)), Some(DVec3::new(-1.4, 0.1, -0.3))] {
        if let Some(p) = grown {
            let seen = |f: &Facet| f.normal.dot(p) - f.offset;
            let index = (0..polytope.facet_count)
                .filter(|i| polytope.facets[*i].alive)
                .max_by(|i, j| seen(&polytope.facets[*i]).total_cmp(&seen(&polytope.facets[*j])))
                .unwrap();
            let Facet { normal, offset, .. } = polytope.facets[index];
            assert!(polytope.grow(&Weak { index, normal, offset, hangs_on: None }, p).is_ok());
        }
        for k in 0..50 {
            let cos = 0.02 * f64::from(k);
            let sin = (1.0 - cos * cos).sqrt();
            let tried = (0..20_000).map(|i| {
                let (y, x) = (f64::from(i) * 1e-4 * std::f64::consts::PI).sin_cos();
                let m = n * cos + DVec3::new(x, y, 0.0) * sin;
                polytope.points[..polytope.point_count].iter().map(|p| m.dot(*p)).fold(f64::NEG_INFINITY, f64::max)
            });
            let (found, tried) = (polytope.least_at(n, cos), tried.fold(f64::INFINITY, f64::min));
            assert!((found - tried).abs() < 1e-3 && found <= tried + 1e-12, "{cos}: {found}, tried {tried}");
        }
    }
}
