//! The audit: a search over all directions for a plane that is nearer than the tracked one, by branch and bound.
//!
//! For a triangle of directions `m_i` and any point `v` of the C-obstacle, every plane of the C-obstacle whose normal
//! lies in the triangle has `f <= max_i m_i.(x - v)` as long as that is negative: so a triangle is done with when one
//! `v` (or a mixture of those known: a 3 x 3 matrix game) keeps the bound below the target. Else it is split at the
//! normal of the plane through its three support points, as EPA does, or across its longest edge.

use crate::walk::{Found, Placed};
use spatial::DVec3;

/// Support evaluations one audit may spend.
const MAX_SUPPORTS: u32 = 192;
/// Triangles one audit may hold open.
const MAX_OPEN: usize = 96;
/// Directions around the pole.
const RING: usize = 5;

#[derive(Clone, Copy)]
struct Corner {
    m: DVec3,
    /// `x - v`, with `v` the support point of the C-obstacle along `m`.
    w: DVec3,
    /// `-m.w`: how deep `x` is below the supporting plane, metres.
    depth: f64,
    a: u32,
    b: u32,
}

#[derive(Clone, Copy)]
struct Triangle {
    corners: [Corner; 3],
    at_pole: bool,
}

const NO_CORNER: Corner = Corner { m: DVec3::ZERO, w: DVec3::ZERO, depth: 0.0, a: 0, b: 0 };

/// Room for the open triangles; made once.
#[derive(Clone)]
pub(crate) struct AuditScratch {
    open: Box<[Triangle; MAX_OPEN]>,
}

impl AuditScratch {
    pub(crate) fn new() -> Self {
        Self { open: Box::new([Triangle { corners: [NO_CORNER; 3], at_pole: false }; MAX_OPEN]) }
    }
}

impl std::fmt::Debug for AuditScratch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("AuditScratch")
    }
}

/// What an audit finds.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Verdict {
    /// Every other plane is farther by at least `slack` outside the cap around the normal; `slack < 0`: no farther
    /// reaching statement.
    Proven { tan_half_cap: f64, slack: f64 },
    /// A direction whose supporting plane is nearer, and the vertices of A and B that support it.
    Nearer { direction: DVec3, a: u32, b: u32 },
    /// The budget ran out.
    Open,
}

/// Three vectors' matrix game: an upper bound for `f` over the triangle.
#[inline]
fn bound(c: &[Corner; 3]) -> f64 {
    let row = |i: usize| DVec3::new(c[i].m.dot(c[0].w), c[i].m.dot(c[1].w), c[i].m.dot(c[2].w));
    let rows = [row(0), row(1), row(2)];
    let pure = rows[0].max(rows[1]).max(rows[2]).min_element();
    let mix = rows[0].cross(rows[1]) + rows[1].cross(rows[2]) + rows[2].cross(rows[0]);
    let sum = mix.element_sum();
    let lambda = mix / sum;
    if lambda.min_element() >= 0.0 && lambda.is_finite() {
        // All rows agree there but for rounding: the largest is the safe one.
        let mixed = rows[0].dot(lambda).max(rows[1].dot(lambda)).max(rows[2].dot(lambda));
        return pure.min(mixed);
    }
    pure
}

/// The angle from Near's normal to the corners of a ring outside of which the ball that the C-obstacle holds about
/// `c_B - R c_A` keeps every plane farther than Near's by the slack returned; none if the ring would be too wide.
fn ball_cap(placed: &Placed<'_>, near: &Found, slack: f64) -> Option<(f64, f64)> {
    let e = -near.face.distance;
    let to_ball = placed.b.center - placed.r * placed.a.center - placed.x;
    let (away, rho) = (to_ball.length(), placed.a.inner_radius + placed.b.inner_radius);
    let spare = slack.min(0.1 * (rho - e));
    let cos = (rho - e - spare) / away;
    if !(spare > 0.0 && cos < 1.0) {
        return None;
    }
    let lean = (-near.face.normal_w.dot(to_ball) / away).clamp(-1.0, 1.0).acos();
    let cap = lean + cos.acos();
    // The sides of a ring of five cut inside the circle through its corners.
    (cap < 1.0).then(|| (1.02 * (cap.tan() / (std::f64::consts::PI / RING as f64).cos()).atan(), spare))
}

struct Audit<'a, 'p> {
    placed: &'a Placed<'p>,
    target: f64,
    tolerance: f64,
    supports: u32,
    a: u32,
    b: u32,
}

impl Audit<'_, '_> {
    /// The support at `m`; `Err` if its plane is nearer than the target.
    fn corner(&mut self, m: DVec3, planes: &mut u32) -> Result<Corner, Verdict> {
        self.supports += 1;
        *planes += 1;
        let p = self.placed;
        self.b = p.b.lowest(-m, self.b, planes);
        self.a = p.a.lowest(p.rt * m, self.a, planes);
        let w = p.x + p.r * p.a.points[self.a as usize] - p.b.points[self.b as usize];
        let depth = -m.dot(w);
        if depth < self.target - self.tolerance {
            return Err(Verdict::Nearer { direction: m, a: self.a, b: self.b });
        }
        Ok(Corner { m, w, depth, a: self.a, b: self.b })
    }
}

/// Looks for a plane nearer to `x` than `near`'s, starting from the two vertices given.
pub(crate) fn audit(
    placed: &Placed<'_>,
    near: &Found,
    start: (u32, u32),
    scratch: &mut AuditScratch,
    planes: &mut u32,
) -> Verdict {
    match search(placed, near, start, scratch, planes) {
        Ok(v) | Err(v) => v,
    }
}

fn search(
    placed: &Placed<'_>,
    near: &Found,
    start: (u32, u32),
    scratch: &mut AuditScratch,
    planes: &mut u32,
) -> Result<Verdict, Verdict> {
    let target = -near.face.distance;
    let size = placed.a.radius + placed.b.radius;
    let mut audit = Audit { placed, target, tolerance: 4e-13 * size + placed.eps, supports: 0, a: start.0, b: start.1 };
    let n = near.face.normal_w;
    let (u, v) = n.any_orthonormal_pair();
    // Leave to the C-face's extent what it proves by itself, with a fifth to spare for the motion to come.
    let reach = if target > 0.0 { 0.8 * near.inside / target } else { 3.0 };
    let covered = reach > 0.05;
    let beyond = ball_cap(placed, near, 0.02 * size);
    let tan_half_cap = match beyond {
        _ if covered => reach.min(1.5),
        // The fan around the pole reaches to where the balls take over.
        Some((cap, _)) => (0.5 * cap).tan(),
        None => 0.2,
    };
    let ring_angle = 2.0 * tan_half_cap.atan();
    let (cos, sin) = {
        let t2 = tan_half_cap * tan_half_cap;
        ((1.0 - t2) / (1.0 + t2), 2.0 * tan_half_cap / (1.0 + t2))
    };
    let azimuth = |i: usize, shift: f64| {
        let angle = std::f64::consts::TAU * (i as f64 + shift) / RING as f64;
        u * angle.cos() + v * angle.sin()
    };
    let pole = audit.corner(n, planes)?;
    let mut ring = [NO_CORNER; RING];
    for (i, c) in ring.iter_mut().enumerate() {
        *c = audit.corner((n * cos + azimuth(i, 0.0) * sin).normalize(), planes)?;
    }
    let mut open = 0;
    let stack = &mut scratch.open;
    let mut push = |corners: [Corner; 3], at_pole: bool| {
        stack[open] = Triangle { corners, at_pole };
        open += 1;
    };
    if !covered {
        for i in 0..RING {
            push([pole, ring[i], ring[(i + 1) % RING]], true);
        }
    }
    let strip = |inner: &[Corner; RING], outer: &[Corner; RING], push: &mut dyn FnMut([Corner; 3], bool)| {
        for i in 0..RING {
            let j = (i + 1) % RING;
            push([inner[i], inner[j], outer[i]], false);
            push([outer[i], inner[j], outer[j]], false);
        }
    };
    let mut slack = if covered { f64::INFINITY } else { -1.0 };
    if let Some((cap, spare)) = beyond {
        // The inscribed balls answer for everything outside this cap.
        if cap > ring_angle {
            let mut outer = [NO_CORNER; RING];
            for (i, c) in outer.iter_mut().enumerate() {
                *c = audit.corner((n * cap.cos() + azimuth(i, 0.5) * cap.sin()).normalize(), planes)?;
            }
            strip(&ring, &outer, &mut push);
        }
        slack = slack.min(spare);
    } else {
        let mut last = ring;
        if cos > -0.2 {
            // A second ring half way to the antipode.
            let middle = 0.5 * (ring_angle + std::f64::consts::PI);
            let mut outer = [NO_CORNER; RING];
            for (i, c) in outer.iter_mut().enumerate() {
                *c = audit.corner((n * middle.cos() + azimuth(i, 0.5) * middle.sin()).normalize(), planes)?;
            }
            strip(&ring, &outer, &mut push);
            last = outer;
        }
        let antipode = audit.corner(-n, planes)?;
        for i in 0..RING {
            push([last[i], last[(i + 1) % RING], antipode], false);
        }
    }
    while open > 0 {
        open -= 1;
        let t = stack[open];
        let spare = -audit.target - bound(&t.corners);
        let gap = t.corners.iter().map(|c| c.depth - audit.target).fold(f64::INFINITY, f64::min);
        // Be content with a third of what the corners leave: proofs that last, without splitting for ever.
        if spare >= (0.3 * gap).min(0.1 * size) - audit.tolerance {
            if !t.at_pole {
                slack = slack.min(spare);
            }
            continue;
        }
        if audit.supports >= MAX_SUPPORTS || open + 3 > MAX_OPEN {
            return Err(Verdict::Open);
        }
        let [p, q, r] = t.corners;
        (audit.a, audit.b) = (p.a, p.b);
        let flat = (q.w - p.w).cross(r.w - p.w);
        let flat = if flat.dot(p.m + q.m + r.m) < 0.0 { -flat } else { flat };
        let length = flat.length();
        let inside = |m: DVec3| {
            let total = p.m.cross(q.m).dot(r.m);
            let part = [p.m.cross(q.m).dot(m), q.m.cross(r.m).dot(m), r.m.cross(p.m).dot(m)];
            part.iter().all(|d| d * total.signum() > 1e-3 * total.abs())
        };
        let candidate = flat / length;
        if length > 1e-9 * size * size && inside(candidate) {
            let c = audit.corner(candidate, planes)?;
            for corners in [[p, q, c], [q, r, c], [r, p, c]] {
                stack[open] = Triangle { corners, at_pole: t.at_pole };
                open += 1;
            }
        } else {
            let lengths = [p.m.dot(q.m), q.m.dot(r.m), r.m.dot(p.m)];
            let [p, q, r] = if lengths[0] <= lengths[1] && lengths[0] <= lengths[2] {
                [p, q, r]
            } else if lengths[1] <= lengths[2] {
                [q, r, p]
            } else {
                [r, p, q]
            };
            let c = audit.corner((p.m + q.m).normalize(), planes)?;
            stack[open] = Triangle { corners: [p, c, r], at_pole: t.at_pole };
            stack[open + 1] = Triangle { corners: [c, q, r], at_pole: t.at_pole };
            open += 2;
        }
    }
    Ok(Verdict::Proven { tan_half_cap, slack: if covered { slack.max(-1.0) } else { -1.0 } })
}
