//! Where one vertex, or one edge, is all that comes near enough to take part, a contact region needs no clipping.

use crate::region::along_edge::EdgeOnFace;
use crate::region::point::{RegionPoint, Scope, own_tolerance, push_within};
use crate::region::way::Gone;
use crate::solid::{Pair, facing_point};
use cspace::{BasicContact, CFace, EdgeId, Plane, Polyhedron, VertexId};
use spatial::DVec3;

/// Contacts whose depths differ by less than this part of the moving part's size take place together; half as much again keeps
/// them together once they are, so that the formation does not chatter.
pub(crate) const TIED: f64 = 1e-6;

/// What takes place, but for places and depths.
#[derive(Clone, Copy, Debug)]
enum Settled {
    Nothing,
    /// Near's own contact alone, of a vertex and a face.
    Alone,
    /// The same of two edges.
    Crossing,
    /// Contacts along one edge of A.
    Edge(EdgeOnFace),
}

/// What was found of a pair, and how far it holds: from tick to tick it nearly always does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    contact: BasicContact,
    /// How far above Near the search went, metres.
    within: f64,
    /// Way of the part up to which the same takes place.
    until: Gone,
    settled: Settled,
}

impl Known {
    pub const NOTHING: Self = Self {
        contact: BasicContact::TypeC { edge_a: EdgeId(0), edge_b: EdgeId(0) },
        within: 0.0,
        until: Gone::NEVER,
        settled: Settled::Nothing,
    };

    fn holds(&self, contact: BasicContact, within: f64, gone: Gone) -> bool {
        gone.is_before(self.until) && contact == self.contact && within <= self.within
    }
}

/// Appends the contacts that [`crate::region::Clipper::region`] would find, if these are no more than `within` metres above `near`
/// along its normal and a vertex or an edge of one body is all that comes so near to the other. False if it is not or may not be so.
pub(crate) fn tied_contacts(
    pair: &Pair<'_>,
    near: &CFace,
    within: f64,
    scope: &Scope,
    (known, gone, lever): (&mut Known, Gone, f64),
    out: &mut Vec<RegionPoint>,
) -> bool {
    if known.holds(near.contact, within, gone) && push_settled(pair, near, within, scope, &known.settled, out) {
        return true;
    }
    known.until = Gone::NEVER;
    let Some((settled, slack)) = settle(pair, near, within, scope, lever) else { return false };
    let all = push_settled(pair, near, within, scope, &settled, out);
    if all && slack.way > 0.0 && slack.turn > 0.0 {
        let settled = match settled {
            Settled::Edge(e) => Settled::Edge(e.while_moving()),
            other => other,
        };
        *known = Known { contact: near.contact, within, until: gone.after(slack), settled };
    }
    all
}

/// Appends what was settled, where it is now. False, and nothing, if that cannot be sure.
fn push_settled(
    pair: &Pair<'_>,
    near: &CFace,
    within: f64,
    scope: &Scope,
    settled: &Settled,
    out: &mut Vec<RegionPoint>,
) -> bool {
    let Pair { a, b, placed, .. } = *pair;
    let own = match settled {
        Settled::Nothing => return true,
        Settled::Edge(e) => return e.push(pair, near, within, scope, out),
        Settled::Crossing => facing_point(pair, near, 0.0),
        Settled::Alone => match near.contact {
            BasicContact::TypeB { vertex_a, .. } => {
                Some(placed.point(a.vertex(vertex_a)) - near.normal_w * near.distance)
            }
            BasicContact::TypeA { vertex_b, .. } => Some(b.vertex(vertex_b)),
            BasicContact::TypeC { .. } => None,
        },
    };
    let Some(point_w) = own else { return false };
    push_within(out, RegionPoint::of(near, point_w));
    true
}

/// What takes place, and how far the part may go before that could change.
fn settle(pair: &Pair<'_>, near: &CFace, within: f64, scope: &Scope, lever: f64) -> Option<(Settled, Gone)> {
    let Pair { a, b, placed, .. } = *pair;
    let up = placed.r.transpose() * near.normal_w;
    let along_edge = |edge| match EdgeOnFace::find(pair, near, edge, (up, within), scope, lever)? {
        (Some(e), slack) => Some((Settled::Edge(e), slack)),
        (None, slack) => Some((Settled::Nothing, slack)),
    };
    match near.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            let foot = placed.point(a.vertex(vertex_a)) - near.normal_w * near.distance;
            let stand = Stand::of(a, vertex_a, up);
            let flattest = stand.flattest;
            lone(pair, (b.face_sides(face_b), foot), (&stand, within), 1.0).or_else(|| along_edge(flattest))
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let at = placed.seen_from_a(b.vertex(vertex_b));
            let stand = Stand::of(b, vertex_b, -near.normal_w);
            lone(pair, (a.face_sides(face_a), at), (&stand, within), 1.2 * (at.length() / lever).max(1.0))
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            lone_crossing(pair, near, (edge_a, edge_b), (up, within), lever).or_else(|| along_edge(edge_a))
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
    /// Of the body, metres.
    size: f64,
}

impl Stand {
    fn of(body: &Polyhedron, vertex: VertexId, up: DVec3) -> Self {
        let mut stand = Self { slope: f64::INFINITY, flattest: EdgeId(0), rise: f64::INFINITY, size: body.size() };
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

/// Near's own contact, if its vertex stands at `at` well inside of the face's sides and alone; nothing, if well outside. Seen from
/// the face, the place moves by no more than `per_way` of the part's way.
fn lone(
    pair: &Pair<'_>,
    (sides, at): (&[Plane], DVec3),
    (stand, within): (&Stand, f64),
    per_way: f64,
) -> Option<(Settled, Gone)> {
    let clear = 2.0 * within / stand.slope;
    let beyond = sides.iter().map(|s| s.signed_distance(at)).fold(f64::NEG_INFINITY, f64::max);
    // While the slope stays at least half of what it is, what is clear grows to twice that at most.
    let half = 0.5 * stand.slope;
    if beyond < -clear && stand.rise > 2.0 * within {
        let rises = (stand.rise - 2.0 * within) / (2.0 * stand.size);
        let slack = Gone { way: (-beyond - 2.0 * clear) / per_way, turn: half.min(rises) };
        return Some((Settled::Alone, slack));
    }
    let tolerance = own_tolerance(pair);
    let slack = Gone { way: (beyond - (2.0 * clear).max(tolerance)) / per_way, turn: half };
    (beyond > clear.max(tolerance)).then_some((Settled::Nothing, slack))
}

/// The contact of the two edges of `near`, if they cross steeply and far from their ends.
fn lone_crossing(
    pair: &Pair<'_>,
    near: &CFace,
    (edge_a, edge_b): (EdgeId, EdgeId),
    (up, within): (DVec3, f64),
    lever: f64,
) -> Option<(Settled, Gone)> {
    let Pair { a, b, placed, .. } = *pair;
    let at = facing_point(pair, near, 0.0)?;
    let (on_a, along_a) = (placed.seen_from_a(at + near.normal_w * near.distance), a.edge_direction(edge_a));
    let cross = (placed.r * along_a).cross(b.edge_direction(edge_b)).length();
    let slope = slope_of_edge(a, edge_a, -up).min(slope_of_edge(b, edge_b, near.normal_w));
    let clear = 2.0 * within / (slope * cross);
    let beyond = |body: &Polyhedron, edge: EdgeId, at: DVec3| {
        let of_face = |f| body.face_edges(f).iter().zip(body.face_sides(f)).filter(|(e, _)| **e != edge);
        let others = body.edge(edge).faces.into_iter().flat_map(of_face);
        others.map(|(_, side)| side.signed_distance(at)).fold(f64::NEG_INFINITY, f64::max)
    };
    let beyond = beyond(a, edge_a, on_a).max(beyond(b, edge_b, at));
    if !(beyond < -clear) {
        return None;
    }
    // So far as the slopes stay at least 0.78, the angle 0.9 of what they are: the common normal then turns by no more than 1.2 times
    // the part's turn over the angle, and the crossing moves by no more than twice its way over the angle.
    let is_shallow = near.distance.abs() < 0.1 * lever * cross;
    let turn = if is_shallow { 0.1 * cross * slope.min(cross) } else { 0.0 };
    let slack = Gone { way: (-beyond - 1.5 * clear) * cross / 2.0, turn };
    Some((Settled::Crossing, slack))
}

/// The lesser slope at which the faces at an edge fall away from the plane through the edge with this outward normal.
fn slope_of_edge(body: &Polyhedron, edge: EdgeId, outward: DVec3) -> f64 {
    let across = body.edge_direction(edge).cross(outward);
    body.edge(edge).faces.iter().map(|f| body.face_plane(*f).normal.dot(across).abs()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
