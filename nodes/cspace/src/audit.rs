//! The audit: is any plane of the C-obstacle nearer to `x` than the tracked one, or does one prove freedom?
//!
//! A polytope of points of the C-obstacle is grown around `x` under the tracked C-face, which is a part of it, until
//! none of its facets is nearer than that face, or until a supporting plane is found that is.
//!
//! Why that proves the depth `e`. The polytope's surface is closed: every directed edge is met by its reverse, and
//! growing keeps this. Every facet has `x` on its inner side at a positive distance, so the solid angles under which
//! `x` sees the facets are all positive and add up to a whole number of spheres, at least one: every ray from `x` meets
//! a facet. A point `y` within the distance `e` of `x` is inside all the facets' planes, so the ray through `y` meets
//! its facet no earlier than at `y`, and `y` lies between points of the C-obstacle, which is convex. So the ball of
//! radius `e` about `x` is in the C-obstacle, and no plane of it is nearer than `e`. The argument does not need the
//! polytope to be convex or its facets to be well chosen; rounding enters through each facet's distance alone, of
//! which a lower bound is used.

use crate::BasicContact;
use crate::inner_polytope::{InnerPolytope, Stuck, Weak};
use crate::placed::Placed;
use crate::walk::Found;
use spatial::DVec3;

/// Most corners that the polygon on top may have; of a face with more, some are taken.
const TOP_CORNERS: usize = 8;

/// The part of the disc that a cap takes, and the least cap that is worth it, tangent of half its angle.
const CAP: f64 = 0.6;
const LEAST_CAP: f64 = 0.03;

/// Room for the polytope; made once.
#[derive(Clone)]
pub(crate) struct AuditScratch {
    polytope: Box<InnerPolytope>,
}

impl AuditScratch {
    pub(crate) fn new() -> Self {
        Self { polytope: Box::new(InnerPolytope::new()) }
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

/// The corners of the C-face of `contact` relative to `x`, counter-clockwise seen from outside; at most `TOP_CORNERS`.
fn corners(placed: &Placed<'_>, found: &Found, out: &mut [DVec3; TOP_CORNERS]) -> usize {
    let (a, b) = (placed.a, placed.b);
    let point = |va: u32, vb: u32| b.points[vb as usize] - placed.turn_to_w(a.points[va as usize]) - placed.x();
    let pick = |sides: &[crate::body::Side], p: DVec3, out: &mut [DVec3; TOP_CORNERS], at: &dyn Fn(u32) -> DVec3| {
        let n = sides.len();
        if n <= TOP_CORNERS {
            sides.iter().zip(out.iter_mut()).for_each(|(s, o)| *o = at(s.corner));
            return n;
        }
        // Both ends of the side that is nearest, and others evenly around.
        let beyond = |i: usize| sides[i].out.dot(p) - sides[i].offset;
        let near = (0..n).max_by(|i, j| beyond(*i).total_cmp(&beyond(*j))).unwrap_or(0);
        out[0] = at(sides[near].corner);
        for (k, o) in out.iter_mut().enumerate().skip(1) {
            *o = at(sides[(near + 1 + (k - 1) * (n - 1) / (TOP_CORNERS - 1)) % n].corner);
        }
        TOP_CORNERS
    };
    match found.face.contact {
        BasicContact::TypeB { vertex_a: v, face_b: f } => {
            let p = placed.point_in_w(a.points[v.index()]);
            pick(b.sides(f.0), p, out, &|w| point(v.0, w))
        }
        BasicContact::TypeA { face_a: f, vertex_b: v } => {
            let p = placed.point_in_a(b.points[v.index()]);
            let n = pick(a.sides(f.0), p, out, &|w| point(w, v.0));
            // Turned over: A's outward is the C-face's inward.
            out[..n].reverse();
            n
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            let (va, vb) = (a.rods[edge_a.index()].vertices, b.rods[edge_b.index()].vertices);
            let ring = [point(va[0], vb[0]), point(va[0], vb[1]), point(va[1], vb[1]), point(va[1], vb[0])];
            out[..4].copy_from_slice(&ring);
            if (ring[1] - ring[0]).cross(ring[2] - ring[1]).dot(found.face.normal_w) < 0.0 {
                out[..4].reverse();
            }
            4
        }
    }
}

/// A point of the C-obstacle, as seen from `x`, and its distance along the direction it was asked for.
struct Support {
    point: DVec3,
    depth: f64,
    a: u32,
    b: u32,
}

fn support(placed: &Placed<'_>, m: DVec3, planes: &mut u32) -> Support {
    *planes += 1;
    let b = placed.b.lowest_of_all(-m, planes);
    let a = placed.a.lowest_of_all(placed.turn_to_a(m), planes);
    let point = placed.b.points[b as usize] - placed.turn_to_w(placed.a.points[a as usize]) - placed.x();
    Support { point, depth: m.dot(point), a, b }
}

/// Looks for a plane nearer to `x` than `near`'s. `x` must be inside Near's plane.
pub(crate) fn audit(placed: &Placed<'_>, near: &Found, scratch: &mut AuditScratch, planes: &mut u32) -> Verdict {
    let n = near.face.normal_w;
    let e = -near.face.distance;
    let size = placed.a.radius + placed.b.radius;
    let tolerance = 4e-13 * size + placed.eps();
    let polytope = &mut *scratch.polytope;
    let mut top = [DVec3::ZERO; TOP_CORNERS];
    let count = corners(placed, near, &mut top);
    polytope.start(&top[..count], support(placed, -n, planes).point, 2.0 * size);
    // At the surface itself a positive distance is asked for: the proof needs it.
    let enough = (e - 1.5 * tolerance).max(0.5 * e);
    let plane = |polytope: &mut InnerPolytope, weak: &Weak, m: DVec3, planes: &mut u32| {
        let s = support(placed, m, planes);
        if s.depth < e - tolerance {
            return Err(Verdict::Nearer { direction: m, a: s.a, b: s.b });
        }
        if !(weak.normal.dot(s.point) - weak.offset > 0.25 * tolerance) {
            return Ok(false);
        }
        match polytope.grow(weak, s.point) {
            Ok(()) => Ok(true),
            Err(Stuck) => Err(Verdict::Open),
        }
    };
    while let Some(weak) = polytope.weakest(enough) {
        // Below an edge of the C-face, the steepest plane that is still far enough tells most.
        if let Some(m) = weak.hangs_on.and_then(|ends| steepest(ends, n, e)) {
            match plane(polytope, &weak, m, planes) {
                Ok(true) => continue,
                Ok(false) => {}
                Err(v) => return v,
            }
        }
        match plane(polytope, &weak, weak.normal, planes) {
            Ok(true) => {}
            Ok(false) => return Verdict::Open,
            Err(v) => return v,
        }
    }
    if !(enough > 0.0) {
        return Verdict::Open;
    }
    reach(placed, polytope, near, e)
}

/// The normal of the plane through the edge of the C-face that passes `x` a little farther than the C-face does.
fn steepest([from, to]: [DVec3; 2], n: DVec3, e: f64) -> Option<DVec3> {
    let out = (to - from).cross(n).normalize();
    let t = 0.9 * out.dot(from) / e;
    (t > 1e-6 && t < 1e6).then(|| (n * (1.0 - t * t) + out * (2.0 * t)) / (1.0 + t * t))
}

/// How far the proof reaches: outside a cap that is left to the C-face's own extent, the minima of the polytope's support function
/// are at its facets' normals, or on the border of the cap.
///
/// The cap is as wide as the disc about the SCP allows with some room; very close to a side, as the folded disc does.
fn reach(placed: &Placed<'_>, polytope: &InnerPolytope, near: &Found, e: f64) -> Verdict {
    let n = near.face.normal_w;
    let beyond_cap = |inside: f64| {
        let t = (CAP * inside / e).min(1.0);
        if !(t > LEAST_CAP) {
            return (0.0, -1.0);
        }
        let cos = (1.0 - t * t) / (1.0 + t * t);
        let border = polytope.least_at(n, cos);
        let outside = polytope.surface().filter(|(m, _)| m.dot(n) <= cos);
        (t, outside.fold(border, |least, (_, sure)| least.min(sure)) - e)
    };
    let (tan_half_cap, slack) = match beyond_cap(near.inside) {
        (_, slack) if slack < 0.0 && near.settled => beyond_cap(placed.folded_disc(&near.face, near.inside)),
        flat => flat,
    };
    Verdict::Proven { tan_half_cap, slack }
}

#[cfg(test)]
mod tests;
