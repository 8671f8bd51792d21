use spatial::DVec3;

/// Most points a polytope holds.
pub(crate) const MAX_POINTS: usize = 96;
/// Most facets made while it grows.
const MAX_FACETS: usize = 250;
/// What lies across the edges of the polygon on top.
const TOP: u8 = u8::MAX;

/// A triangle, counter-clockwise seen from outside.
#[derive(Clone, Copy)]
struct Facet {
    corners: [u8; 3],
    /// The facet across each edge; edge `i` leads from corner `i` to the next.
    across: [u8; 3],
    alive: bool,
    /// Outward unit normal.
    normal: DVec3,
    /// Distance of the facet's plane from the origin, metres.
    offset: f64,
    /// A lower bound of it that holds in spite of rounding.
    sure: f64,
}

const NO_FACET: Facet =
    Facet { corners: [0; 3], across: [0; 3], alive: false, normal: DVec3::ZERO, offset: 0.0, sure: 0.0 };

/// A polytope spanned by points of the C-obstacle, seen from `x`, under a polygon that is part of its surface.
///
/// It grows as the expanding polytope of van den Bergen (2001) does: where a facet is too near, a farther point of the
/// C-obstacle replaces the facets that it sees. The polygon on top stays, for nothing lies beyond it.
#[derive(Clone)]
pub(crate) struct InnerPolytope {
    points: [DVec3; MAX_POINTS],
    facets: [Facet; MAX_FACETS],
    point_count: usize,
    facet_count: usize,
    span: f64,
}

/// The unit direction on the arc from `inner` to `outer` that has the cosine `cos >= 0` with `n`, if `inner` has a larger one and
/// `outer` a smaller one or the same.
fn between(inner: DVec3, outer: DVec3, n: DVec3, cos: f64) -> Option<DVec3> {
    let (z, to) = (inner.dot(n), outer.dot(n));
    if !(z > cos && to <= cos) {
        return None;
    }
    // Where (z + t dz)^2 becomes cos^2 times the square of the chord's length there.
    let (dz, c2) = (to - z, cos * cos);
    let apart = c2 * (1.0 - inner.dot(outer));
    let (a, b, c) = (dz * dz - 2.0 * apart, z * dz + apart, z * z - c2);
    let root = (b * b - a * c).max(0.0).sqrt();
    let t = if b < 0.0 { c / (root - b) } else { -(b + root) / a };
    Some((inner + (outer - inner) * t.clamp(0.0, 1.0)).normalize())
}

/// Why a polytope cannot grow: it is full, or rounding has torn it.
pub(crate) struct Stuck;

/// A facet in need of a farther point.
#[derive(Clone, Copy)]
pub(crate) struct Weak {
    index: usize,
    pub normal: DVec3,
    pub offset: f64,
    /// First and last point of the top's edge that it hangs on, as the top runs.
    pub hangs_on: Option<[DVec3; 2]>,
}

impl InnerPolytope {
    pub(crate) fn new() -> Self {
        Self {
            points: [DVec3::ZERO; MAX_POINTS],
            facets: [NO_FACET; MAX_FACETS],
            point_count: 0,
            facet_count: 0,
            span: 0.0,
        }
    }

    /// A pyramid under the convex polygon `top` (counter-clockwise from above, 3 to 16 corners); no coordinate will
    /// exceed `span`, metres.
    pub(crate) fn start(&mut self, top: &[DVec3], apex: DVec3, span: f64) {
        let n = top.len();
        self.span = span;
        self.points[..n].copy_from_slice(top);
        self.points[n] = apex;
        self.point_count = n + 1;
        self.facet_count = 0;
        for i in 0..n {
            let (next, last) = ((i + 1) % n, (i + n - 1) % n);
            self.push([next as u8, i as u8, n as u8], [TOP, last as u8, next as u8]);
        }
    }

    fn push(&mut self, corners: [u8; 3], across: [u8; 3]) {
        let [p, q, r] = corners.map(|c| self.points[c as usize]);
        let (u, v) = (q - p, r - p);
        let area = u.cross(v);
        let length = area.length();
        let normal = area / length;
        let (low, high) = {
            let d = [normal.dot(p), normal.dot(q), normal.dot(r)];
            (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
        };
        // The cross product is off by at most two roundings of |u||v|, and so is the normal, divided by its length.
        let doubt = 1e-15 * self.span * (1.0 + 0.5 * (u.length_squared() + v.length_squared()) / length);
        self.facets[self.facet_count] = Facet { corners, across, alive: true, normal, offset: high, sure: low - doubt };
        self.facet_count += 1;
    }

    /// The facets of the surface (without the top): normal and sure distance.
    pub(crate) fn surface(&self) -> impl Iterator<Item = (DVec3, f64)> + '_ {
        self.facets[..self.facet_count].iter().filter(|f| f.alive).map(|f| (f.normal, f.sure))
    }

    /// The least of the support function's values over the directions that have the cosine `cos >= 0` with `n`, the top's normal, metres.
    ///
    /// On that circle it is a chain of arcs of sines, one for each corner whose cone of normals the circle passes: it is least where
    /// one changes to the next, which is where the circle crosses the arc between two facets' normals, or where such a sine itself is.
    pub(crate) fn least_at(&self, n: DVec3, cos: f64) -> f64 {
        let mut least = f64::INFINITY;
        for f in self.facets[..self.facet_count].iter().filter(|f| f.alive && f.normal.dot(n) <= cos) {
            for (corner, across) in f.corners.into_iter().zip(f.across) {
                let inner = if across == TOP { n } else { self.facets[across as usize].normal };
                if let Some(m) = between(inner, f.normal, n, cos) {
                    least = least.min(m.dot(self.points[corner as usize]));
                }
            }
        }
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let points = &self.points[..self.point_count];
        for p in points {
            let (up, aside) = (p.dot(n), p.reject_from_normalized(n).normalize_or_zero());
            // `x` is inside: what the corner itself has there must be positive.
            if up * cos > sin * p.dot(aside) {
                let m = n * cos - aside * sin;
                least = least.min(points.iter().map(|q| m.dot(*q)).fold(f64::NEG_INFINITY, f64::max));
            }
        }
        least - 1e-14 * self.span
    }

    /// The facet that is nearest to the origin, if it is not surely `enough` away, metres.
    pub(crate) fn weakest(&self, enough: f64) -> Option<Weak> {
        let mut best: Option<usize> = None;
        for (i, f) in self.facets[..self.facet_count].iter().enumerate() {
            // Written so that a facet without area (not-a-number) is found, too.
            if f.alive && !(f.sure >= enough) && best.is_none_or(|b| !(f.sure >= self.facets[b].sure)) {
                best = Some(i);
            }
        }
        best.map(|index| {
            let f = &self.facets[index];
            let ends = [f.corners[1], f.corners[0]].map(|c| self.points[c as usize]);
            let hangs_on = (f.across[0] == TOP).then_some(ends);
            Weak { index, normal: f.normal, offset: f.offset, hangs_on }
        })
    }

    /// Takes in the point `p`, which `weak` sees.
    pub(crate) fn grow(&mut self, weak: &Weak, p: DVec3) -> Result<(), Stuck> {
        if self.point_count >= MAX_POINTS {
            return Err(Stuck);
        }
        let apex = self.point_count as u8;
        self.points[self.point_count] = p;
        self.point_count += 1;
        let margin = 1e-15 * self.span;
        // The facets that see the point, from `weak` on; the edges around them; who starts at which corner.
        let mut stack = [0u8; MAX_FACETS];
        let mut open = 1;
        stack[0] = weak.index as u8;
        self.facets[weak.index].alive = false;
        let first = self.facet_count;
        let mut starts = [TOP; MAX_POINTS];
        while open > 0 {
            open -= 1;
            let at = stack[open];
            let Facet { corners, across, .. } = self.facets[at as usize];
            for i in 0..3 {
                let (from, to, other) = (corners[i], corners[(i + 1) % 3], across[i]);
                if other != TOP {
                    let o = &mut self.facets[other as usize];
                    if !o.alive {
                        continue;
                    }
                    if o.normal.dot(p) - o.offset > margin {
                        o.alive = false;
                        stack[open] = other;
                        open += 1;
                        continue;
                    }
                }
                if self.facet_count >= MAX_FACETS || starts[from as usize] != TOP {
                    return Err(Stuck);
                }
                starts[from as usize] = self.facet_count as u8;
                self.push([from, to, apex], [other, TOP, TOP]);
            }
        }
        for i in first..self.facet_count {
            let Facet { corners: [from, to, _], across: [other, ..], .. } = self.facets[i];
            let next = starts[to as usize];
            if next == TOP {
                return Err(Stuck);
            }
            self.facets[i].across[1] = next;
            self.facets[next as usize].across[2] = i as u8;
            if other != TOP {
                let o = &mut self.facets[other as usize];
                match (0..3).find(|k| o.corners[*k] == to && o.corners[(k + 1) % 3] == from) {
                    Some(k) => o.across[k] = i as u8,
                    None => return Err(Stuck),
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
