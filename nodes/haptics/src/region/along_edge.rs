//! An edge of A that lies along a face of B, and all else of A out of reach: the contacts are where the face's sides cut it.

use crate::region::face_pair::{Corner, FacePair};
use crate::region::facing_faces::{each_beside_chosen, most_parallel_by};
use crate::region::point::{RegionPoint, Scope, own_tolerance, push_within};
use crate::region::span::{Cut, Span};
use crate::region::way::Gone;
use crate::solid::{Pair, facing_point};
use cspace::{BasicContact, CFace, EdgeId, FaceId, Plane, Polyhedron, VertexId};
use spatial::DVec3;

/// Two edges that cross less steeply have a common normal that turns too fast to tell how, sine.
const STEEP: f64 = 0.5;
/// By how much what is clear of the edge may shrink, since its slopes do, while what was found holds.
const GROWS: f64 = 1.5;

/// Which edge lies along which face, and the sides that its ends lie beyond, or close to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeOnFace {
    faces: (FaceId, FaceId),
    /// Position of the edge in the ring of A's face.
    edge: u32,
    /// Position of its second vertex there.
    next: u32,
    /// Its vertices, and those before and after them.
    ends: [VertexId; 2],
    beside: [VertexId; 2],
    /// For each end the side that cuts it off, and the side that it comes close to.
    cuts: [u32; 2],
    close: [u32; 2],
    /// What of A may be in reach is no farther from the edge than this, metres.
    clear: f64,
}

impl EdgeOnFace {
    /// The contacts along `edge`, if of A only that may come within `within` metres above `near`, `up` being Near's normal as A sees it:
    /// none of it, where the edge lies beyond a side; and how far the part may go before the answer may change.
    pub fn find(
        pair: &Pair<'_>,
        near: &CFace,
        edge: EdgeId,
        (up, within): (DVec3, f64),
        scope: &Scope,
        lever: f64,
    ) -> Option<(Option<Self>, Gone)> {
        let Pair { a, b, placed, .. } = *pair;
        let (slope, rise) = slope_at_ends(a, edge, up, within)?;
        let tolerance = own_tolerance(pair);
        let clear = (2.0 * within / slope).max(tolerance);
        if scope.wide || !(clear < a.size()) {
            return None;
        }
        let (chosen, lead) = most_parallel_by(pair, near)?;
        let faces = FacePair::new(pair, chosen, near.normal_w, scope)?;
        if faces.may_go_on() {
            return None;
        }
        let i = faces.edges_a().iter().position(|e| *e == edge)?;
        let ring = faces.ring_a();
        let after = |i: usize| if i + 1 == ring.len() { 0 } else { i + 1 };
        let next = after(i);
        let mut found = Self {
            faces: chosen,
            edge: i as u32,
            next: next as u32,
            ends: [ring[i], ring[next]],
            beside: [ring[if i == 0 { ring.len() - 1 } else { i - 1 }], ring[after(next)]],
            cuts: [Cut::NONE; 2],
            close: [Cut::NONE; 2],
            clear,
        };
        let ends = found.ends.map(|v| placed.point(a.vertex(v)));
        let (mut turn, moves) = steadiness(near, &faces, ends, (slope, rise, lead), lever);
        // What lies along another face at the edges, too, is cut by the sides of that.
        let mut is_lone = true;
        each_beside_chosen(pair, near, chosen, |height, _| {
            is_lone &= height > GROWS * 2.0 * within;
            turn = turn.min((height - GROWS * 2.0 * within) / a.size().max(b.size()));
        });
        if !is_lone {
            return None;
        }
        let [foot, other] = ends.map(|p| faces.foot(p));
        let along = other - foot;
        let mut span = Span::WHOLE;
        // How far the ends stay off the sides that they are not close to.
        let mut off = f64::INFINITY;
        for (j, side) in faces.sides_b().iter().enumerate() {
            let p = side.signed_distance(foot);
            let q = p + side.normal.dot(along);
            if p > clear && q > clear {
                return Some((None, Gone { way: (p.min(q) - (GROWS * clear).max(tolerance)) / moves, turn }));
            }
            match [p.abs() <= clear, q.abs() <= clear] {
                [false, false] => {
                    span.cut(j as u32, p, q, 0.0);
                    off = off.min(p.abs()).min(q.abs());
                }
                // One end, and at one side only; the other may lie beyond another side.
                [at_from, at_to] if at_from != at_to && found.close[usize::from(at_to)] == Cut::NONE => {
                    found.close[usize::from(at_to)] = j as u32;
                    off = off.min(if at_from { -q } else { -p });
                }
                _ => return None,
            }
        }
        found.cuts = [span.enter.side, span.leave.side];
        let is_double = (0..2).any(|k| found.cuts[k] != Cut::NONE && found.close[k] != Cut::NONE);
        let way = if is_double { 0.0 } else { (off - GROWS * clear) / moves };
        Some((Some(found), Gone { way, turn }))
    }

    /// The same for as long as it holds.
    pub fn while_moving(self) -> Self {
        Self { clear: GROWS * self.clear, ..self }
    }

    /// Appends the contacts, where they are now. False, and nothing, if they are not or may not be all of the region.
    pub fn push(&self, pair: &Pair<'_>, near: &CFace, within: f64, scope: &Scope, out: &mut Vec<RegionPoint>) -> bool {
        let Pair { a, placed, .. } = *pair;
        if scope.wide {
            return false;
        }
        let Some(faces) = FacePair::new(pair, self.faces, near.normal_w, scope) else { return false };
        let ends = self.ends.map(|v| placed.point(a.vertex(v)));
        let [foot, other] = ends.map(|p| faces.foot(p));
        let along = other - foot;
        let sides = faces.sides_b();
        let mut span = Span::WHOLE;
        for (k, at) in ends.into_iter().enumerate() {
            for (j, is_close) in [(self.cuts[k], false), (self.close[k], true)] {
                let Some(side) = sides.get(j as usize) else { continue };
                let p = side.signed_distance(foot);
                let q = p + side.normal.dot(along);
                // What else of A's face comes to this side there?
                let end = (at, if k == 0 { p } else { q });
                let is_sure = !(p > 0.0 && q > 0.0);
                if !is_sure || is_close && !passes(&faces, side, end, placed.point(a.vertex(self.beside[k])), within) {
                    return false;
                }
                span.cut(j, p, q, 0.0);
            }
        }
        // Nothing beside the edge may meet a side where the edge itself does not, and no vertex of B lie beside it.
        let clear = self.clear * along.length();
        let is_apart = |cut: &Cut| {
            let Some(crossed) = sides.get(cut.side as usize) else { return true };
            let at = foot + along * cut.line;
            let across = crossed.normal.dot(along).abs();
            let is_clear = |side: &Plane| side.signed_distance(at) * across < -clear;
            sides.iter().enumerate().all(|(j, side)| j == cut.side as usize || is_clear(side))
        };
        if span.is_empty() || !is_apart(&span.enter) || !is_apart(&span.leave) {
            return false;
        }
        let cuts = [&span.enter, &span.leave];
        let corner = |k: usize| match cuts[k].side {
            Cut::NONE => Corner::OfA([self.edge, self.next][k] as usize),
            side => Corner::Crossing(self.edge as usize, side as usize),
        };
        // Near's own contact comes first, with the plane that it has; it counts even where the face goes on beyond.
        let own = (0..2).find(|k| faces.basic_contact(corner(*k)) == near.contact);
        let own_point = match own {
            Some(k) => Some(foot + along * cuts[k].line),
            None => facing_point(pair, near, own_tolerance(pair)),
        };
        if let Some(point_w) = own_point {
            push_within(out, RegionPoint::of(near, point_w));
        }
        for k in (0..2).filter(|k| own != Some(*k)) {
            if let Some(found) = faces.contact(corner(k), ends[0] + (ends[1] - ends[0]) * cuts[k].line) {
                push_within(out, found);
            }
        }
        true
    }
}

/// The turn up to which the same faces lie along the edge and nothing else comes into reach, radians, by the slopes and rises at the edge
/// and the lead of these faces over others; and how far the ends' feet move, by the part's way. No turn, where that is too hard to tell.
fn steadiness(
    near: &CFace,
    faces: &FacePair<'_>,
    ends: [DVec3; 2],
    (slope, rise, lead): (f64, f64, f64),
    lever: f64,
) -> (f64, f64) {
    let Pair { a, b, placed, .. } = faces.pair;
    // By how much more than the part Near's normal turns, as A sees it.
    let (turns, moves) = match near.contact {
        BasicContact::TypeC { edge_a, edge_b } => {
            let cross = (placed.r * a.edge_direction(edge_a)).cross(b.edge_direction(edge_b)).length();
            let is_low = ends.iter().all(|p| faces.height(*p).abs() < 0.1 * lever);
            if !(cross > STEEP && faces.least_cosine() > 0.8 && is_low) {
                return (0.0, 1.0);
            }
            (3.5, 4.0)
        }
        _ => (1.0, 1.0),
    };
    let own = ((1.0 - 1.0 / GROWS) * slope).min(rise / (2.0 * a.size())) / turns;
    (own.min(0.5 * lead).min(0.05).min((faces.least_cosine() - 0.2) / turns), moves)
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

/// The least slope of the other edges at the ends of one, along `up`, and how far above reach the vertices lie that they lead to,
/// metres; none if one of them is in reach.
fn slope_at_ends(body: &Polyhedron, edge: EdgeId, up: DVec3, within: f64) -> Option<(f64, f64)> {
    let ends = body.edge(edge).vertices;
    let [from, to] = ends.map(|v| up.dot(body.vertex(v)));
    let reach = from.min(to) + 2.0 * within;
    let (mut least, mut lowest) = (f64::INFINITY, f64::INFINITY);
    for vertex in ends {
        for (other, neighbor) in body.vertex_edges(vertex).iter().zip(body.vertex_vertices(vertex)) {
            if *other != edge {
                lowest = lowest.min(up.dot(body.vertex(*neighbor)));
                least = least.min(up.dot(body.edge_direction(*other)).abs());
            }
        }
    }
    (lowest > reach).then_some((least, lowest - reach))
}
