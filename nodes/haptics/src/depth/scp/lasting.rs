//! What is found of a pair and holds while the part goes on: whether a contact is one of the uncut solids, and whether it takes place.

use crate::region::Gone;
use crate::solid::{Cover, Covered, Margin, Pair, Seams, closest_places, facing_point, nearest_in_face};
use cspace::{BasicContact, CFace, EdgeId, FaceId, Plane, Polyhedron, contact_point_turned};
use spatial::DVec3;

/// While A turns by less than this part of the sine between two edges, and again of that sine, their common normal turns by no more
/// than [`NORMAL`] times the turn over the sine, and the place where they cross moves by no more than [`PLACE`] times the way over it.
const TURNED: f64 = 0.1;
const NORMAL: f64 = 1.2;
const PLACE: f64 = 2.0;
/// The distance between such edges, in parts of the sine and of the lever.
const SHALLOW: f64 = 0.1;
/// How much faster than A's farthest point goes a point of W that A sees as far off.
const SEEN: f64 = 1.2;

const EVER: Gone = Gone { way: f64::INFINITY, turn: f64::INFINITY };

/// What was found of a contact, and the way of the part up to which it holds.
#[derive(Clone, Copy, Debug)]
struct Found {
    contact: BasicContact,
    holds: bool,
    until: Gone,
}

impl Found {
    const NOTHING: Self = Self {
        contact: BasicContact::TypeC { edge_a: EdgeId(0), edge_b: EdgeId(0) },
        holds: false,
        until: Gone::NEVER,
    };

    #[inline]
    fn of(&self, contact: BasicContact, gone: Gone) -> Option<bool> {
        (gone.is_before(self.until) && self.contact == contact).then_some(self.holds)
    }
}

/// What was found of a pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lasting {
    felt: [Found; 2],
    facing: Found,
}

impl Lasting {
    pub const NOTHING: Self = Self { felt: [Found::NOTHING; 2], facing: Found::NOTHING };

    /// See [`Pair::is_felt`].
    #[inline]
    pub fn is_felt<'a>(
        &mut self,
        c: &CFace,
        covered: Covered,
        (gone, lever): (Gone, f64),
        pair: impl FnOnce() -> Pair<'a>,
    ) -> bool {
        let found = &mut self.felt[covered as usize];
        found.of(c.contact, gone).unwrap_or_else(|| {
            let (holds, slack) = felt(&pair(), c, covered, lever);
            *found = Found { contact: c.contact, holds, until: gone.after(slack) };
            holds
        })
    }

    /// Whether the features of a contact that touch face each other, within `tolerance` metres.
    #[inline]
    pub fn faces<'a>(
        &mut self,
        contact: BasicContact,
        tolerance: f64,
        (gone, lever): (Gone, f64),
        touching: impl FnOnce() -> (Pair<'a>, CFace),
    ) -> bool {
        self.facing.of(contact, gone).unwrap_or_else(|| {
            let (pair, c) = touching();
            let (holds, slack) = facing(&pair, &c, tolerance, lever);
            self.facing = Found { contact, holds, until: gone.after(slack) };
            holds
        })
    }
}

/// Whether the contact is one of the uncut solids, and how far that holds.
#[inline(never)]
fn felt(pair: &Pair<'_>, c: &CFace, covered: Covered, lever: f64) -> (bool, Gone) {
    let Pair { solids, part, piece, a, b, placed } = *pair;
    if solids.is_seamless(part, piece) {
        return (true, EVER);
    }
    let (moving, fixed) = (&solids.moving, &solids.fixed);
    let at = || contact_point_turned(c.contact, a, b, placed.x, &placed.r);
    let (face, margin) = match c.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            let places = || [at(), placed.point(a.center())].map(|p| (p, 1.0));
            let up = placed.r.transpose() * -c.normal_w;
            let alone = moving.is_alone(part);
            let margin = if alone { Margin::ANYWHERE } else { moving.margin_at_vertex(part, vertex_a, up) };
            (open_face(fixed, (piece, b, face_b), covered, places), margin)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let seen = |p: DVec3| {
                let p = placed.seen_from_a(p);
                (p, SEEN * (p.length() / lever).max(1.0))
            };
            let alone = fixed.is_alone(piece);
            let margin = if alone { Margin::ANYWHERE } else { fixed.margin_at_vertex(piece, vertex_b, c.normal_w) };
            (open_face(moving, (part, a, face_a), covered, || [at(), b.center()].map(seen)), margin)
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            let of_b = if fixed.is_alone(piece) {
                Margin::ANYWHERE
            } else {
                fixed.margin_on_edge(piece, edge_b, at, c.normal_w)
            };
            if of_b.felt && !moving.is_alone(part) {
                let on_a = placed.seen_from_a(at() + c.normal_w * c.distance);
                // In how far is not told.
                return (moving.is_felt(part, on_a, -(placed.r.transpose() * c.normal_w)), Gone::NEVER);
            }
            return (of_b.felt, while_crossing(pair, (edge_a, edge_b), c.distance, of_b, lever));
        }
    };
    match face {
        (false, way) => (false, Gone { way, turn: f64::INFINITY }),
        _ if !margin.felt => (false, Gone { way: f64::INFINITY, turn: margin.turn }),
        (true, way) => (true, Gone { way, turn: margin.turn }),
    }
}

/// Whether the face is felt at one of two places, in its body's frame, and while the part goes how far, metres. A place goes no more
/// than so many times as far.
fn open_face(
    seams: &Seams,
    (piece, body, face): (usize, &Polyhedron, FaceId),
    covered: Covered,
    places: impl FnOnce() -> [(DVec3, f64); 2],
) -> (bool, f64) {
    match seams.cover(piece, face) {
        Cover::Open => return (true, f64::INFINITY),
        Cover::Internal => return (false, f64::INFINITY),
        Cover::Partial if covered == Covered::Felt => return (true, f64::INFINITY),
        Cover::Partial => {}
    }
    let [first, second] = places().map(|(p, per_way)| {
        let uncovered = seams.uncovered_by(piece, face, nearest_in_face(body, face, p));
        // Beyond the face's sides its nearest place may be anywhere soon.
        let way = inside_by(body.face_sides(face), p).max(0.0).min(uncovered.abs()) / per_way;
        (uncovered > 0.0, way)
    });
    match (first.0, second.0) {
        (true, true) => (true, first.1.max(second.1)),
        (true, false) => first,
        (false, true) => second,
        (false, false) => (false, first.1.min(second.1)),
    }
}

/// Whether the features of a contact that touch face each other within `tolerance` metres, and how far that holds.
#[inline(never)]
fn facing(pair: &Pair<'_>, c: &CFace, tolerance: f64, lever: f64) -> (bool, Gone) {
    let Pair { a, b, placed, .. } = *pair;
    // By how much it lies inside of all that bounds it, metres.
    let and_slack = |inside: f64, slack_of: &dyn Fn(f64) -> Gone| match inside {
        i if i > 0.0 => (true, slack_of(i)),
        i if i < -tolerance => (false, slack_of(-tolerance - i)),
        _ => (facing_point(pair, c, tolerance).is_some(), Gone::NEVER),
    };
    let straight = |way: f64| Gone { way, turn: f64::INFINITY };
    match c.contact {
        BasicContact::TypeB { vertex_a, face_b } => {
            and_slack(inside_by(b.face_sides(face_b), placed.point(a.vertex(vertex_a))), &straight)
        }
        BasicContact::TypeA { face_a, vertex_b } => {
            let p = placed.seen_from_a(b.vertex(vertex_b));
            let per_way = SEEN * (p.length() / lever).max(1.0);
            and_slack(inside_by(a.face_sides(face_a), p), &|way| straight(way / per_way))
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            let ends_a = a.edge(edge_a).vertices.map(|v| placed.point(a.vertex(v)));
            let ends_b = b.edge(edge_b).vertices.map(|v| b.vertex(v));
            let Some((s, t)) = closest_places(ends_a, ends_b) else { return (false, Gone::NEVER) };
            let inside = |s: f64, [from, to]: [DVec3; 2]| s.min(1.0 - s) * from.distance(to);
            and_slack(inside(s, ends_a).min(inside(t, ends_b)), &|way| {
                while_crossing(pair, (edge_a, edge_b), c.distance, Margin { way, ..Margin::ANYWHERE }, lever)
            })
        }
    }
}

/// How far the part may go while the crossing of two edges at this distance, metres, keeps to the margin.
fn while_crossing(
    pair: &Pair<'_>,
    (edge_a, edge_b): (EdgeId, EdgeId),
    distance: f64,
    margin: Margin,
    lever: f64,
) -> Gone {
    let sine = (pair.placed.r * pair.a.edge_direction(edge_a)).cross(pair.b.edge_direction(edge_b)).length();
    if !(distance.abs() < SHALLOW * lever * sine) {
        return Gone::NEVER;
    }
    Gone { way: margin.way * sine / PLACE, turn: (margin.turn * sine / NORMAL).min(TURNED * sine * sine) }
}

/// How far inside of the sides the place lies, metres; less than zero outside.
fn inside_by(sides: &[Plane], p: DVec3) -> f64 {
    sides.iter().map(|side| -side.signed_distance(p)).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
