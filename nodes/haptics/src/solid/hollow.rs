//! Edges that end at a joint where the solid is hollow, as the rim of a polygonal hole does at its corners.

use crate::solid::Pair;
use crate::solid::facing::closest_places;
use crate::solid::features::{edges_of_a, edges_of_b};
use cspace::{BasicContact, CFace, EdgeId, is_applicable_turned};
use spatial::DVec3;

/// Farthest past a joint that the contact before it counts, metres: more than a hand moves in a tick.
const PAST: f64 = 2e-4;
/// How far from the place, as parts of that, it is asked whether the edge is one of the solid: the joint may lie in the edge's midst.
const BEFORE: [f64; 4] = [1.0, 0.25, 1.0 / 16.0, 1.0 / 64.0];
/// The same as a part of the edge: no nearer to its ends, and no farther.
const INSIDE: f64 = 1e-2;

/// Gives `offer` the edge contacts at Near's features, and `last`, that are the solid's up to a joint and not at it, where another
/// piece stands across, with their places on B. The pair's own nearest plane is a seam's as soon as the place has passed the
/// joint, by however little, while a part that leans into the corner touches on both sides of it. Past such a joint the plane
/// asks nothing that the piece there does not ask, so it may be kept, from `least` to `reach` metres high.
pub(crate) fn each_hollow_end(
    pair: &Pair<'_>,
    near: &CFace,
    last: Option<BasicContact>,
    (least, reach): (f64, f64),
    mut offer: impl FnMut(CFace, DVec3),
) {
    let Pair { solids, part, piece, a, b, placed } = *pair;
    let mut consider = |edge_a: EdgeId, edge_b: EdgeId| {
        let contact = BasicContact::TypeC { edge_a, edge_b };
        let is_live = solids.fixed.is_live_edge(piece, edge_b) && solids.moving.is_live_edge(part, edge_a);
        if is_live && is_applicable_turned(contact, a, b, &placed.r) {
            let plane = CFace::at_turned(contact, a, b, placed.x, &placed.r);
            if (least..=reach).contains(&plane.distance)
                && let Some(at) = hollow_end(pair, (edge_a, edge_b), plane.normal_w)
            {
                offer(plane, at);
            }
        }
    };
    let mut known = None;
    for own in [Some(near.contact), last].into_iter().flatten() {
        if let BasicContact::TypeC { edge_a, edge_b } = own
            && known != Some((edge_a, edge_b))
        {
            known = Some((edge_a, edge_b));
            consider(edge_a, edge_b);
        }
    }
    for edge_b in edges_of_b(b, &near.contact) {
        for edge_a in edges_of_a(a, &near.contact).iter().filter(|e| known != Some((**e, *edge_b))) {
            consider(*edge_a, *edge_b);
        }
    }
}

/// The place on B where the edges come closest, if that is the end of one in a hollow joint, or a little past it, and the
/// edges are the solid's before it.
fn hollow_end(pair: &Pair<'_>, (edge_a, edge_b): (EdgeId, EdgeId), normal_w: DVec3) -> Option<DVec3> {
    let Pair { solids, part, piece, a, b, placed } = *pair;
    let ends_a = a.edge(edge_a).vertices.map(|v| placed.point(a.vertex(v)));
    let ends_b = b.edge(edge_b).vertices.map(|v| b.vertex(v));
    let (on_a, on_b) = closest_places(ends_a, ends_b)?;
    let (past_a, past_b) = (past(on_a, ends_a), past(on_b, ends_b));
    if past_a.max(past_b) > PAST {
        return None;
    }
    let into_a = placed.r.transpose() * -normal_w;
    let felt_a = |s: f64| {
        let at = ends_a[0].lerp(ends_a[1], s);
        solids.moving.is_alone(part) || solids.moving.is_felt(part, placed.seen_from_a(at), into_a)
    };
    let felt_b = |t: f64| {
        let at = ends_b[0].lerp(ends_b[1], t);
        solids.fixed.is_alone(piece) || solids.fixed.is_felt_on_edge(piece, edge_b, || at, normal_w)
    };
    let (s, t) = (on_a.clamp(0.0, 1.0), on_b.clamp(0.0, 1.0));
    let (hollow_a, hollow_b) = (!felt_a(s), !felt_b(t));
    // Past an end that is none of a hollow joint there is nothing.
    let goes_on = |hollow: bool, past: f64| hollow || past == 0.0;
    let is_hollow = (hollow_a || hollow_b) && goes_on(hollow_a, past_a) && goes_on(hollow_b, past_b);
    let felt_near_a = || !hollow_a || places_before(s, ends_a).any(felt_a);
    let felt_near_b = || !hollow_b || places_before(t, ends_b).any(felt_b);
    (is_hollow && felt_near_a() && felt_near_b()).then(|| ends_b[0].lerp(ends_b[1], t))
}

/// Places on either side of `s` where the edge may still be one of the solid.
fn places_before(s: f64, [from, to]: [DVec3; 2]) -> impl Iterator<Item = f64> {
    let length = from.distance(to);
    let at = move |way: f64| (s + way / length).clamp(INSIDE, 1.0 - INSIDE);
    BEFORE.iter().flat_map(move |part| [at(part * PAST), at(-part * PAST)])
}

/// How far beyond the ends the place `s` lies, metres.
fn past(s: f64, [from, to]: [DVec3; 2]) -> f64 {
    (s - s.clamp(0.0, 1.0)).abs() * from.distance(to)
}
