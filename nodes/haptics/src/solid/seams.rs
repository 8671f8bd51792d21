//! Seams between convex pieces of one body: which contacts are artefacts of the cutting.

use crate::solid::cover::{Cover, cover_of};
use cspace::{EdgeId, FaceId, Plane, Polyhedron, VertexId};
use spatial::DVec3;
use std::sync::Arc;

mod margins;
#[cfg(test)]
mod tests;

pub(crate) use margins::Margin;

/// Points this close to a piece's surface (part of the largest piece) count as on it.
const ON_SURFACE: f64 = 1e-7;
/// What lies no farther over another piece than this (part of the largest piece) belongs to it, and a surface goes on in one that
/// stands no lower: files of six or seven digits bend what was flat.
const LEVEL: f64 = 2e-6;
/// A normal may lean this far (radians) over a flat seam and still be the normal of the uncut surface.
const FLAT: f64 = 1e-6;
/// A surface that falls by more than this (radians) beyond a side ends there: meshes hold their facets flat to less.
const FALL: f64 = 1e-3;
/// A surface that rises by more than this (metres per metre) beyond a side stands upright: a vertex has its foot on either face.
const STEEP: f64 = 5.0;

/// Which pieces of a rigid assembly (the whole fixed scene, or the body in the hand) touch or overlap which, found once.
///
/// A face of a piece, or a part of it, that lies inside another piece is no surface of the solid, and neither are the
/// edges and vertices such faces make where the solid is flat or hollow. A contact there is never felt, though its
/// plane still proves freedom.
#[derive(Clone, Debug)]
pub(crate) struct Seams {
    pieces: Vec<Arc<Polyhedron>>,
    /// For each piece the pieces that touch or overlap it.
    neighbors: Vec<Vec<u32>>,
    /// For each piece the cover of its faces.
    cover: Vec<Vec<Cover>>,
    /// For each piece and edge: whether a contact on it can be felt anywhere along it.
    live_edges: Vec<Vec<bool>>,
    /// For each piece, face and side: how much of the side the surface goes on beyond.
    sides: Vec<Vec<Vec<Cover>>>,
    /// For each piece, face and vertex of it whether a border of the face runs straight on there in another piece.
    straight: Vec<Vec<Vec<bool>>>,
    /// For each piece and face whether it ends at an obtuse hollow joint somewhere.
    hollow: Vec<Vec<bool>>,
    /// For each piece and face whether it goes on beyond some side as another face of the piece, but for less than [`FALL`].
    facets: Vec<Vec<bool>>,
    /// For each piece and vertex the neighbours that the vertex belongs to.
    at_vertex: Vec<Vec<Vec<u32>>>,
    /// For each piece and edge the neighbours that some of the edge's points belong to.
    at_edge: Vec<Vec<Vec<Stretch>>>,
    /// For each piece, face, and neighbour that some place just outside of the face may lie in: the neighbour's planes which do not
    /// have all such places inside.
    over_face: Vec<Vec<Vec<Vec<Plane>>>>,
    /// For each piece and face the faces of other pieces that lie in its plane and look the same way.
    flush: Vec<Vec<Vec<(u32, FaceId)>>>,
    tolerance: f64,
    /// See [`LEVEL`], metres.
    level: f64,
}

/// A part of an edge that lies in another piece.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    other: u32,
    /// From the edge's first vertex, metres; infinite where the edge ends in the piece.
    from: f64,
    to: f64,
}

/// Places along an edge where it is judged once and for all; what differs between them is judged in the tick.
const SAMPLES: [f64; 7] = [1e-3, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999];

impl Seams {
    /// Of pieces given in one common frame.
    pub fn new(pieces: Vec<Arc<Polyhedron>>) -> Self {
        let size = pieces.iter().map(|p| p.size()).fold(0.0, f64::max);
        let tolerance = ON_SURFACE * size;
        let touching = |p: &Polyhedron, q: &Polyhedron| {
            // A face plane of either that has the other wholly outside proves them apart.
            let apart = |p: &Polyhedron, q: &Polyhedron| {
                p.faces().any(|f| {
                    let plane = p.face_plane(f);
                    q.corner_ids().all(|v| plane.signed_distance(q.vertex(v)) > 2.0 * tolerance)
                })
            };
            p.center().distance(q.center()) <= p.size() + q.size() + 2.0 * tolerance && !apart(p, q) && !apart(q, p)
        };
        let n = pieces.len();
        let neighbors: Vec<Vec<u32>> = (0..n)
            .map(|a| (0..n).filter(|&b| b != a && touching(&pieces[a], &pieces[b])).map(|b| b as u32).collect())
            .collect();
        let cover: Vec<Vec<Cover>> = (0..n)
            .map(|a| {
                let others = || neighbors[a].iter().map(|&b| &*pieces[b as usize]);
                pieces[a].faces().map(|f| cover_of(&pieces[a], f, others(), tolerance)).collect()
            })
            .collect();
        let flush = flush_faces(&pieces, &cover, tolerance);
        let is_facet = |p: &Polyhedron, f| p.face_faces(f).iter().any(|g| is_same_face(p, f, *g));
        let facets = pieces.iter().map(|p| p.faces().map(|f| is_facet(p, f)).collect()).collect();
        let mut seams = Self {
            pieces,
            neighbors,
            cover,
            live_edges: Vec::new(),
            sides: Vec::new(),
            straight: Vec::new(),
            hollow: Vec::new(),
            facets,
            at_vertex: Vec::new(),
            at_edge: Vec::new(),
            over_face: Vec::new(),
            flush,
            tolerance,
            level: LEVEL * size,
        };
        seams.at_vertex = (0..n).map(|a| seams.owners_of_vertices(a)).collect();
        seams.at_edge = (0..n).map(|a| seams.stretches_of_edges(a)).collect();
        seams.over_face = (0..n).map(|a| seams.planes_over_faces(a)).collect();
        seams.live_edges = (0..n).map(|a| seams.find_live_edges(a)).collect();
        seams.sides = (0..n).map(|a| seams.find_sides(a)).collect();
        seams.straight = (0..n).map(|a| seams.find_straight(a)).collect();
        seams.hollow = (0..n).map(|a| seams.find_hollow(a)).collect();
        seams
    }

    /// The neighbours of `piece` that a point between these may lie in or near: none of their planes has all points outside
    /// by more than the tolerance, and as much again for rounding.
    fn near(&self, piece: usize, points: &[DVec3]) -> Vec<u32> {
        let outside = |q: &Polyhedron| {
            let beyond = |f| points.iter().all(|p| q.face_plane(f).signed_distance(*p) > 2.0 * self.tolerance);
            q.faces().any(beyond)
        };
        self.neighbors[piece].iter().copied().filter(|&other| !outside(&self.pieces[other as usize])).collect()
    }

    fn owners_of_vertices(&self, piece: usize) -> Vec<Vec<u32>> {
        let owners = |v: &DVec3| {
            let owns = |other: &u32| self.pieces[*other as usize].contains(*v, self.level);
            self.neighbors[piece].iter().copied().filter(owns).collect()
        };
        self.pieces[piece].vertices().iter().map(owners).collect()
    }

    fn stretches_of_edges(&self, piece: usize) -> Vec<Vec<Stretch>> {
        let p = &self.pieces[piece];
        let of_edge = |ends: [DVec3; 2]| {
            self.neighbors[piece].iter().filter_map(|&other| self.stretch_within(other, ends)).collect()
        };
        p.edges().map(|e| of_edge(p.edge(e).vertices.map(|v| p.vertex(v)))).collect()
    }

    /// What of the way from one point to another lies in the piece, if any does.
    fn stretch_within(&self, other: u32, [a, b]: [DVec3; 2]) -> Option<Stretch> {
        let q = &self.pieces[other as usize];
        let length = a.distance(b);
        let mut stretch = Stretch { other, from: f64::NEG_INFINITY, to: f64::INFINITY };
        for f in q.faces() {
            let [over_a, over_b] = [a, b].map(|p| q.face_plane(f).signed_distance(p) - self.level);
            match (over_a > 0.0, over_b > 0.0) {
                (true, true) => return None,
                (true, false) => stretch.from = stretch.from.max(length * over_a / (over_a - over_b)),
                (false, true) => stretch.to = stretch.to.min(length * over_a / (over_a - over_b)),
                (false, false) => {}
            }
        }
        (stretch.from <= stretch.to).then_some(stretch)
    }

    fn planes_over_faces(&self, piece: usize) -> Vec<Vec<Vec<Plane>>> {
        let p = &self.pieces[piece];
        let over = |f| {
            let up = p.face_plane(f).normal * (4.0 * self.tolerance);
            let lifted: Vec<DVec3> = p.face_vertices(f).iter().map(|v| p.vertex(*v) + up).collect();
            let cuts = |plane: &Plane| lifted.iter().any(|v| plane.signed_distance(*v) > -2.0 * self.tolerance);
            let planes = |other: u32| {
                let q = &self.pieces[other as usize];
                q.faces().map(|g| q.face_plane(g)).filter(cuts).collect()
            };
            self.near(piece, &lifted).into_iter().map(planes).collect()
        };
        p.faces().map(over).collect()
    }

    fn find_live_edges(&self, piece: usize) -> Vec<bool> {
        let p = &self.pieces[piece];
        p.edges()
            .map(|e| {
                let edge = p.edge(e);
                let [a, b] = edge.vertices.map(|v| p.vertex(v));
                let [f, g] = edge.faces.map(|f| p.face_plane(f).normal);
                SAMPLES.iter().any(|s| self.is_felt_on_edge(piece, e, || a.lerp(b, *s), (f + g).normalize_or_zero()))
            })
            .collect()
    }

    fn find_sides(&self, piece: usize) -> Vec<Vec<Cover>> {
        let p = &self.pieces[piece];
        let of_side = |face: FaceId, side: usize| {
            let [a, b] = side_ends(p, face, side);
            let on = SAMPLES.iter().filter(|s| self.side_goes_on(piece, face, side, a.lerp(b, **s), -FALL)).count();
            match on {
                0 => Cover::Open,
                n if n == SAMPLES.len() => Cover::Internal,
                _ => Cover::Partial,
            }
        };
        p.faces().map(|f| (0..p.face_vertices(f).len()).map(|s| of_side(f, s)).collect()).collect()
    }

    fn find_straight(&self, piece: usize) -> Vec<Vec<bool>> {
        let p = &self.pieces[piece];
        let of_face = |face: FaceId| {
            let ring = p.face_vertices(face);
            let runs_on = |i: usize| {
                let [before, at, after] = [i + ring.len() - 1, i, i + 1].map(|k| p.vertex(ring[k % ring.len()]));
                [before, after].iter().any(|from| self.is_in_another(piece, at, (at - *from).normalize_or_zero(), FALL))
            };
            (0..ring.len()).map(runs_on).collect()
        };
        p.faces().map(of_face).collect()
    }

    fn find_hollow(&self, piece: usize) -> Vec<bool> {
        let p = &self.pieces[piece];
        let rises = |face: FaceId, side: usize| {
            let [a, b] = side_ends(p, face, side);
            SAMPLES.iter().map(|s| a.lerp(b, *s)).any(|at| {
                let rises = |rise| self.side_goes_on(piece, face, side, at, rise);
                rises(FALL) && !rises(STEEP)
            })
        };
        p.faces().map(|f| (0..p.face_vertices(f).len()).any(|side| rises(f, side))).collect()
    }

    /// For each edge of the piece whether a contact on it can be felt at all.
    pub fn live_edges(&self, piece: usize) -> &[bool] {
        &self.live_edges[piece]
    }

    /// Whether a contact on the edge can be felt at all.
    pub fn is_live_edge(&self, piece: usize, edge: EdgeId) -> bool {
        self.live_edges[piece][edge.index()]
    }

    /// How much of each face of the piece lies inside other pieces.
    pub fn covers(&self, piece: usize) -> &[Cover] {
        &self.cover[piece]
    }

    /// How much of the face lies inside other pieces.
    pub fn cover(&self, piece: usize, face: FaceId) -> Cover {
        self.cover[piece][face.index()]
    }

    /// Whether the place just outside of the face at `point` (a point of the face) lies inside another piece.
    pub fn is_covered(&self, piece: usize, face: FaceId, point: DVec3) -> bool {
        let outside = point + self.pieces[piece].face_plane(face).normal * (4.0 * self.tolerance);
        self.over_face[piece][face.index()]
            .iter()
            .any(|planes| planes.iter().all(|plane| plane.signed_distance(outside) <= -self.tolerance))
    }

    /// Whether the piece borders on others at all: if not, all its contacts are felt.
    pub fn is_alone(&self, piece: usize) -> bool {
        self.neighbors[piece].is_empty()
    }

    /// The faces of other pieces in the plane of this one: together they are one face of the solid, or of several.
    pub fn flush(&self, piece: usize, face: FaceId) -> &[(u32, FaceId)] {
        &self.flush[piece][face.index()]
    }

    /// Whether the face's surface goes on in another piece beyond its side `side` at `point` (a point of that side), flat or
    /// rising: then the side is no border of the solid.
    pub fn goes_on(&self, piece: usize, face: FaceId, side: usize, point: DVec3) -> bool {
        match self.sides[piece][face.index()][side] {
            Cover::Open => false,
            Cover::Internal => true,
            Cover::Partial => self.side_goes_on(piece, face, side, point, -FALL),
        }
    }

    /// Whether the face's `corner`-th vertex is one that only a cut makes, at a border of the surface that runs straight on there: in a
    /// piece that narrows, the surface does not go on beyond the end of the cut itself.
    pub fn runs_on(&self, piece: usize, face: FaceId, corner: usize) -> bool {
        self.straight[piece][face.index()][corner]
    }

    /// Whether the face is one of several facets that are one face but for a bend that meshes have: see [`is_same_face`].
    pub fn is_facet(&self, piece: usize, face: FaceId) -> bool {
        self.facets[piece][face.index()]
    }

    /// Whether the surface bends up by less than a right angle at some side of the face.
    pub fn is_hollow(&self, piece: usize, face: FaceId) -> bool {
        self.hollow[piece][face.index()]
    }

    /// Whether any face does: see [`Seams::is_hollow`].
    pub fn has_hollow(&self) -> bool {
        self.hollow.iter().flatten().any(|h| *h)
    }

    /// Whether the point lies inside another piece.
    pub fn is_inside_another(&self, piece: usize, point: DVec3) -> bool {
        self.neighbors[piece].iter().any(|&other| self.pieces[other as usize].contains(point, 0.0))
    }

    /// Whether the surface goes on beyond the side at `point` and rises by `rise` radians or more there, which may be negative.
    fn side_goes_on(&self, piece: usize, face: FaceId, side: usize, point: DVec3, rise: f64) -> bool {
        let p = &self.pieces[piece];
        let normal = p.face_plane(face).normal;
        let [from, to] = side_ends(p, face, side);
        let outward = (to - from).cross(normal).normalize_or_zero();
        // Bevels are shallow, so what lies beyond is told by the planes that meet at the point, not by a point farther on.
        self.is_in_another(piece, point, outward + normal * rise, FLAT)
    }

    /// Whether what lies beyond `point` in a unit direction is another piece, which may bend away from it by `bend` radians.
    fn is_in_another(&self, piece: usize, point: DVec3, beyond: DVec3, bend: f64) -> bool {
        let here = 8.0 * self.tolerance;
        self.neighbors[piece].iter().any(|&other| {
            let q = &self.pieces[other as usize];
            q.faces().all(|f| {
                let plane = q.face_plane(f);
                let above = plane.signed_distance(point);
                above < -here || above <= self.level && plane.normal.dot(beyond) <= bend
            })
        })
    }

    /// Whether a contact at `point` on the surface of `piece`, with the outward `normal`, both in the pieces' frame, is one
    /// of the uncut solid: the contact plane must support every piece that the point belongs to.
    pub fn is_felt(&self, piece: usize, point: DVec3, normal: DVec3) -> bool {
        self.neighbors[piece].iter().all(|&other| {
            !self.pieces[other as usize].contains(point, self.level) || self.supports(other, point, normal)
        })
    }

    /// The same of a contact at a vertex.
    pub fn is_felt_at_vertex(&self, piece: usize, vertex: VertexId, normal: DVec3) -> bool {
        let point = self.pieces[piece].vertex(vertex);
        self.at_vertex[piece][vertex.index()].iter().all(|&other| self.supports(other, point, normal))
    }

    /// The same of a contact at a point on an edge, between its ends.
    pub fn is_felt_on_edge(&self, piece: usize, edge: EdgeId, point: impl FnOnce() -> DVec3, normal: DVec3) -> bool {
        let stretches = &self.at_edge[piece][edge.index()];
        if stretches.is_empty() {
            return true;
        }
        let (p, point) = (&self.pieces[piece], point());
        let along = p.edge_direction(edge).dot(point - p.vertex(p.edge(edge).vertices[0]));
        let is_within = |s: &&Stretch| s.from <= along && along <= s.to;
        stretches.iter().filter(is_within).all(|s| self.supports(s.other, point, normal))
    }

    /// The piece, and how far along the normal it may reach if the plane through the point supports it, metres.
    fn piece_below(&self, piece: u32, point: DVec3, normal: DVec3) -> (&Polyhedron, f64) {
        let q = &self.pieces[piece as usize];
        (q, normal.dot(point) + FLAT * 2.0 * q.size() + self.level)
    }

    /// Whether the plane through `point` with the outward `normal` has no more of the piece beyond it than a flat seam lets out.
    fn supports(&self, piece: u32, point: DVec3, normal: DVec3) -> bool {
        let (q, highest) = self.piece_below(piece, point, normal);
        q.corner_ids().all(|v| normal.dot(q.vertex(v)) <= highest)
    }
}

/// For each piece and face the faces of the solids' surface, of other pieces, that are one plane with it.
fn flush_faces(pieces: &[Arc<Polyhedron>], cover: &[Vec<Cover>], tolerance: f64) -> Vec<Vec<Vec<(u32, FaceId)>>> {
    let open = |a: usize| pieces[a].faces().filter(move |f| cover[a][f.index()] != Cover::Internal);
    let mut flush: Vec<Vec<Vec<(u32, FaceId)>>> =
        pieces.iter().map(|p| p.faces().map(|_| Vec::new()).collect()).collect();
    for (a, p) in pieces.iter().enumerate() {
        for (b, q) in pieces.iter().enumerate().skip(a + 1) {
            for f in open(a) {
                let plane = p.face_plane(f);
                for g in open(b) {
                    let in_plane = |v| plane.signed_distance(q.vertex(v)).abs() <= 2.0 * tolerance;
                    if plane.normal.dot(q.face_plane(g).normal) > 0.5 && q.face_vertices(g).iter().all(|v| in_plane(*v))
                    {
                        flush[a][f.index()].push((b as u32, g));
                        flush[b][g.index()].push((a as u32, f));
                    }
                }
            }
        }
    }
    flush
}

/// Whether two faces that share an edge bend there by so little that they are one face of the body, rounded or a little bulged.
pub(crate) fn is_same_face(body: &Polyhedron, face: FaceId, other: FaceId) -> bool {
    let [n, m] = [face, other].map(|f| body.face_plane(f).normal);
    n.distance_squared(m) <= FALL * FALL
}

/// Where the side of a face begins and ends.
fn side_ends(p: &Polyhedron, face: FaceId, side: usize) -> [DVec3; 2] {
    let ring = p.face_vertices(face);
    [side, (side + 1) % ring.len()].map(|k| p.vertex(ring[k]))
}
