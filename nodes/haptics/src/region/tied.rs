//! The region of contacts whose depths tie, where a vertex or an edge alone decides it: most are so, and need no clipping.

use crate::region::face_pair::{Corner, FacePair};
use crate::region::facing_faces::most_parallel;
use crate::region::point::{RegionPoint, Scope, own_tolerance, push_within};
use crate::region::span::{Cut, Span};
use crate::solid::{Pair, facing_point};
use cspace::{BasicContact, CFace, EdgeId, Plane, Polyhedron, VertexId};
use spatial::DVec3;

/// Contacts whose depths differ by less than this part of the moving part's size take place together; half as much again keeps
/// them together once they are, so that the formation does not chatter.
pub(crate) const TIED: f64 = 1e-6;

/// Appends the contacts that [`crate::region::Clipper::region`] would find, if these are no more than `within` metres above `near`
/// along its normal and a vertex or an edge of one body is all that comes so near to the other. False if it is not or may not be so.
pub(crate) fn tied_contacts(
    pair: &Pair<'_>,
    near: &CFace,
    within: f64,
    scope: &Scope,
    out: &mut Vec<RegionPoint>,
) -> bool {
    let Pair { a, b, placed, .. } = *pair;
    let up = placed.r.transpose() * near.normal_w;
    match near.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            let foot = placed.point(a.vertex(vertex_a)) - near.normal_w * near.distance;
            let stand = Stand::of(a, vertex_a, up);
            lone(pair, near, (b.face_sides(face_b), foot), (&stand, within), foot, out)
                || along_edge(pair, near, stand.flattest, (up, within), scope, out)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let at = b.vertex(vertex_b);
            let stand = Stand::of(b, vertex_b, -near.normal_w);
            lone(pair, near, (a.face_sides(face_a), placed.seen_from_a(at)), (&stand, within), at, out)
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            if let Some(point_w) = lone_crossing(pair, near, (edge_a, edge_b), up, within) {
                push_within(out, RegionPoint::of(near, point_w));
                return true;
            }
            along_edge(pair, near, edge_a, (up, within), scope, out)
        }
    }
}

/// How a body stands on its lowest vertex.
struct Stand {
    /// The least slope of the edges there: a point of the body at height h is no farther from the vertex than h over that.
    slope: f64,
    flattest: EdgeId,
    /// The least height of the neighbours, metres.
    rise: f64,
}

impl Stand {
    fn of(body: &Polyhedron, vertex: VertexId, up: DVec3) -> Self {
        let mut stand = Self { slope: f64::INFINITY, flattest: EdgeId(0), rise: f64::INFINITY };
        let at = body.vertex(vertex);
        for (edge, neighbor) in body.vertex_edges(vertex).iter().zip(body.vertex_vertices(vertex)) {
            let slope = up.dot(body.edge_direction(*edge)).abs();
            if slope < stand.slope {
                (stand.slope, stand.flattest) = (slope, *edge);
            }
            stand.rise = stand.rise.min(up.dot(body.vertex(*neighbor) - at));
        }
        stand
    }
}

/// Near's own contact, at `point_w` on B, if its vertex stands at `at` well inside of the face's sides and alone; nothing, if well
/// outside.
fn lone(
    pair: &Pair<'_>,
    near: &CFace,
    (sides, at): (&[Plane], DVec3),
    (stand, within): (&Stand, f64),
    point_w: DVec3,
    out: &mut Vec<RegionPoint>,
) -> bool {
    let clear = 2.0 * within / stand.slope;
    let beyond = sides.iter().map(|s| s.signed_distance(at)).fold(f64::NEG_INFINITY, f64::max);
    let is_alone = beyond < -clear && stand.rise > 2.0 * within;
    if is_alone {
        push_within(out, RegionPoint::of(near, point_w));
    }
    is_alone || beyond > clear.max(own_tolerance(pair))
}

/// Where the two edges of `near` cross on B, if they do so steeply and far from their ends.
fn lone_crossing(
    pair: &Pair<'_>,
    near: &CFace,
    (edge_a, edge_b): (EdgeId, EdgeId),
    up: DVec3,
    within: f64,
) -> Option<DVec3> {
    let Pair { a, b, placed, .. } = *pair;
    let at = facing_point(pair, near, 0.0)?;
    let (on_a, along_a) = (placed.seen_from_a(at + near.normal_w * near.distance), a.edge_direction(edge_a));
    let cross = (placed.r * along_a).cross(b.edge_direction(edge_b)).length();
    let slope = slope_of_edge(a, edge_a, -up).min(slope_of_edge(b, edge_b, near.normal_w));
    let clear = 2.0 * within / (slope * cross);
    let stands = |body: &Polyhedron, edge: EdgeId, at: DVec3| {
        body.edge(edge).faces.iter().all(|f| {
            let others = body.face_edges(*f).iter().zip(body.face_sides(*f)).filter(|(e, _)| **e != edge);
            others.map(|(_, side)| side).all(|s| s.signed_distance(at) < -clear)
        })
    };
    (stands(a, edge_a, on_a) && stands(b, edge_b, at)).then_some(at)
}

/// The lesser slope at which the faces at an edge fall away from the plane through the edge with this outward normal.
fn slope_of_edge(body: &Polyhedron, edge: EdgeId, outward: DVec3) -> f64 {
    let across = body.edge_direction(edge).cross(outward);
    body.edge(edge).faces.iter().map(|f| body.face_plane(*f).normal.dot(across).abs()).fold(f64::INFINITY, f64::min)
}

/// The same as [`tied_contacts`] where of A only `edge` may come near enough: it is cut by the sides of B's face.
fn along_edge(
    pair: &Pair<'_>,
    near: &CFace,
    edge: EdgeId,
    (up, within): (DVec3, f64),
    scope: &Scope,
    out: &mut Vec<RegionPoint>,
) -> bool {
    let Pair { a, placed, .. } = *pair;
    let Some(slope) = slope_at_ends(a, edge, up, within) else { return false };
    let clear = (2.0 * within / slope).max(own_tolerance(pair));
    if scope.wide || !(clear < a.size()) {
        return false;
    }
    let Some(faces) = most_parallel(pair, near).and_then(|f| FacePair::new(pair, f, near.normal_w, scope)) else {
        return false;
    };
    if faces.may_go_on() {
        return false;
    }
    let Some(i) = faces.edges_a().iter().position(|e| *e == edge) else { return false };
    let ring = faces.ring_a();
    let next = if i + 1 == ring.len() { 0 } else { i + 1 };
    let [from, to] = [i, next].map(|k| placed.point(a.vertex(ring[k])));
    let (foot, along) = (faces.foot(from), faces.foot(to) - faces.foot(from));
    let sides = faces.sides_b();
    let mut span = Span::WHOLE;
    let mut close = [0; 2];
    for (j, side) in sides.iter().enumerate() {
        let p = side.signed_distance(foot);
        let q = p + side.normal.dot(along);
        let (near_from, near_to) = (p.abs() <= clear, q.abs() <= clear);
        if near_from || near_to {
            // What else of A's face comes to this side there?
            let before = if i == 0 { ring.len() - 1 } else { i - 1 };
            let after = if next + 1 == ring.len() { 0 } else { next + 1 };
            let (k, end, s, beside) = if near_from { (0, from, p, ring[before]) } else { (1, to, q, ring[after]) };
            close[k] += 1;
            let is_sure = near_from != near_to && close[k] == 1 && !(p > 0.0 && q > 0.0);
            if !is_sure || !passes(&faces, side, (end, s), placed.point(a.vertex(beside)), within) {
                return false;
            }
        }
        if p > 0.0 && q > 0.0 {
            return true;
        }
        span.cut(j as u32, p, q, 0.0);
    }
    // Nothing beside the edge may meet a side where the edge itself does not, and no vertex of B lie beside it.
    let is_apart = |cut: &Cut| {
        let Some(crossed) = sides.get(cut.side as usize) else { return true };
        let at = foot + along * cut.line;
        let clear = clear * along.length() / crossed.normal.dot(along).abs();
        sides.iter().enumerate().all(|(j, side)| j == cut.side as usize || side.signed_distance(at) < -clear)
    };
    if span.is_empty() || !is_apart(&span.enter) || !is_apart(&span.leave) {
        return false;
    }
    let corner = |cut: &Cut, vertex: usize| {
        let corner = if cut.side == Cut::NONE { Corner::OfA(vertex) } else { Corner::Crossing(i, cut.side as usize) };
        faces.contact(corner, from + (to - from) * cut.line)
    };
    let (enter, leave) = (corner(&span.enter, i), corner(&span.leave, next));
    // Near's own contact comes first, with the plane that it has; it counts even where the face goes on beyond.
    let is_own = |p: &RegionPoint| p.contact == near.contact;
    let own_point = match enter.iter().chain(&leave).find(|p| is_own(p)) {
        Some(p) => Some(p.point_w),
        None => facing_point(pair, near, own_tolerance(pair)),
    };
    if let Some(point_w) = own_point {
        push_within(out, RegionPoint::of(near, point_w));
    }
    for found in enter.iter().chain(&leave).filter(|p| !is_own(p)) {
        push_within(out, *found);
    }
    true
}

/// Whether the edge of A's face from `end`, which lies beyond a side of B's by `s` metres, to `beside` rises out of reach before it comes
/// to that side, if it does.
fn passes(faces: &FacePair<'_>, side: &Plane, (end, s): (DVec3, f64), beside: DVec3, within: f64) -> bool {
    let (from, to) = (faces.height(end), faces.height(beside));
    let r = side.signed_distance(faces.foot(beside));
    let out_of_reach = faces.highest + 0.01 * within;
    let comes = (r > 0.0) != (s > 0.0);
    to > out_of_reach
        && s.abs() > own_tolerance(&faces.pair) * 1e-2
        && !(comes && from + (to - from) * (s / (s - r)) <= out_of_reach)
}

/// The least slope of the other edges at the ends of one, along `up`; none if one of them leads to a vertex within reach.
fn slope_at_ends(body: &Polyhedron, edge: EdgeId, up: DVec3, within: f64) -> Option<f64> {
    let ends = body.edge(edge).vertices;
    let [from, to] = ends.map(|v| up.dot(body.vertex(v)));
    let reach = from.min(to) + 2.0 * within;
    let mut least = f64::INFINITY;
    for vertex in ends {
        for (other, neighbor) in body.vertex_edges(vertex).iter().zip(body.vertex_vertices(vertex)) {
            if *other != edge {
                if up.dot(body.vertex(*neighbor)) <= reach {
                    return None;
                }
                least = least.min(up.dot(body.edge_direction(*other)).abs());
            }
        }
    }
    Some(least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::Clipper;
    use crate::solid::{Covered, Placed, Sense, Solids};
    use crate::testing::cuboid;
    use cspace::{FixedPart, World};
    use rand::{RngExt, SeedableRng};
    use spatial::{DQuat, Pose};
    use std::sync::Arc;

    /// A corner of a floor in two pieces and a wall beside it, two planks in the hand.
    fn corner() -> Arc<World> {
        let moving =
            [([-0.008, -0.005, -0.015], [0.008, 0.005, 0.015]), ([-0.008, 0.005, -0.015], [0.008, 0.009, 0.01])];
        let fixed = [
            ([-0.03, -0.025, -0.01], [0.004, 0.025, 0.0]),
            ([0.004, -0.025, -0.01], [0.012, 0.025, 0.0]),
            ([0.012, -0.025, -0.01], [0.03, 0.025, 0.012]),
        ];
        let cuboid = |(low, high): ([f64; 3], [f64; 3])| Arc::new(cuboid(low.into(), high.into()));
        Arc::new(World {
            moving: moving.map(cuboid).into(),
            fixed: fixed.map(|f| FixedPart { polyhedron: cuboid(f), obstacle: 0 }).into(),
        })
    }

    #[test]
    fn what_a_vertex_or_an_edge_decides_is_what_clipping_finds() {
        let solids = Solids::new(corner());
        let (mut sense, mut clipper) = (Sense::new(solids.world.clone(), 0.005), Clipper::for_world(&solids.world));
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        let (mut quick, mut clipped) = (Vec::with_capacity(64), Vec::with_capacity(64));
        let mut settled = [0; 4];
        let mut left = 0;
        for _ in 0..30_000 {
            // Upright, or on an edge, and turned from there by very little about some axes.
            let mut small = || if rng.random_bool(0.4) { 0.0 } else { 10.0_f64.powf(rng.random_range(-9.0..-1.5)) };
            let tilt = DQuat::from_scaled_axis(DVec3::new(small(), -small(), small()));
            let quarter = f64::from(rng.random_range(0..8)) * std::f64::consts::FRAC_PI_4;
            let axis = [DVec3::X, DVec3::Y, DVec3::Z][rng.random_range(0..3)];
            let rotation = (tilt * DQuat::from_axis_angle(axis, quarter)).normalize();
            let turned = |v: DVec3| rotation * v;
            let extent = |axis: fn(DVec3) -> f64| {
                let all = solids.world.moving.iter().flat_map(|p| p.vertices()).map(|v| axis(turned(*v)));
                all.fold(0.0, f64::max)
            };
            let (down, ahead) = (extent(|v| -v.z), extent(|v| v.x));
            // Into the floor, and anywhere, or into the wall as well, or only so far that both are just touched.
            let mut little = || 10.0_f64.powf(rng.random_range(-11.0..-4.0));
            let (into_floor, into_wall) = (little(), little());
            let (x, z) = match rng.random_range(0..3) {
                0 => (rng.random_range(-0.02..0.02), down - 1e-4),
                1 => (0.012 - ahead + into_wall, down - 1e-4),
                _ => (0.012 - ahead + into_wall, down - into_floor),
            };
            let pose = Pose::new(DVec3::new(x, rng.random_range(-0.02..0.02), z), rotation);
            sense.reset();
            sense.step(&pose);
            let placed = Placed::new(&pose);
            for s in sense.pairs.iter().filter(|s| s.near.distance < 0.0) {
                let pair = Pair::of(&solids, s, &placed);
                let Some(plane) = pair.felt_plane(&s.near, Covered::Felt, &mut None) else { continue };
                let within = 2.0 * pair.a.size() * TIED;
                let scope = Scope { reach: plane.distance + within, near_felt: true, wide: false, along_near: true };
                quick.clear();
                if !tied_contacts(&pair, &plane, within, &scope, &mut quick) {
                    left += 1;
                    continue;
                }
                settled[quick.len()] += 1;
                clipped.clear();
                clipper.region(&pair, &plane, &scope, &mut clipped);
                let missing = |from: &[RegionPoint], of: &[RegionPoint]| {
                    of.iter().any(|p| {
                        let same = |q: &RegionPoint| {
                            q.contact == p.contact
                                && q.point_w.distance(p.point_w) < 1e-12
                                && (q.gap - p.gap).abs() < 1e-14
                                && q.normal_w.distance(p.normal_w) < 1e-9
                        };
                        // At the very limit rounding decides.
                        p.gap < scope.reach - 1e-14 && !from.iter().any(same)
                    })
                };
                let differ = missing(&quick, &clipped) || missing(&clipped, &quick);
                assert!(!differ, "{pose:?} {plane:?}: {quick:?}, clipped {clipped:?}");
            }
        }
        assert!(
            settled[..3].iter().all(|n| *n > 1000),
            "nothing, one and two contacts {settled:?}, left to clipping {left}"
        );
    }
}
