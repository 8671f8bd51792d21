//! A face of A laid on a face of B: where they lie over each other, and what takes place there.

use crate::region::facing_faces::FACING;
use crate::region::point::{PARALLEL_EDGES, RegionPoint, Scope};
use crate::solid::{Pair, is_same_face};
use cspace::{BasicContact, EdgeId, FaceId, Plane, VertexId};
use spatial::DVec3;

/// Where a corner of the region comes from: positions in the rings of A's and of B's face.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Corner {
    /// A vertex of A over B's face.
    OfA(usize),
    /// A vertex of B under A's face.
    OfB(usize),
    /// An edge of A over one of B.
    Crossing(usize, usize),
}

/// Cosines between the two faces, and between either and the sight, below which they do not lie over each other.
const STEEP: f64 = 0.1;
/// Vertices past a joint by a face that they lie farther below than this are none of its contacts, metres.
const BELOW: f64 = 1e-6;
/// How far (sine) the normal of two edges may lean away from the outside of a face: a tick may turn it back.
const AWAY: f64 = 0.02;

/// Two faces and the direction in which they are laid on each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacePair<'a> {
    pub pair: Pair<'a>,
    face_a: FaceId,
    face_b: FaceId,
    pub scope: Scope,
    /// Near's normal, axes of W.
    pub near_w: DVec3,
    /// Unit, axes of W.
    sight: DVec3,
    /// Of A's face, inward.
    normal_a: DVec3,
    plane_b: Plane,
    /// Cosines between the normals of the faces, and between the sight and B's.
    lean: f64,
    slope: f64,
    /// Corners higher than this above B's plane are beyond the scope, metres.
    pub highest: f64,
}

impl<'a> FacePair<'a> {
    /// None if the faces do not lie over each other. `near_w` is Near's normal.
    pub fn new(pair: &Pair<'a>, (face_a, face_b): (FaceId, FaceId), near_w: DVec3, scope: &Scope) -> Option<Self> {
        let plane_b = pair.b.face_plane(face_b);
        let normal_a = -(pair.placed.r * pair.a.face_plane(face_a).normal);
        let sight = if scope.along_near { near_w } else { plane_b.normal };
        let (lean, slope) = (normal_a.dot(plane_b.normal), sight.dot(plane_b.normal));
        if lean <= STEEP || slope <= STEEP || sight.dot(normal_a) <= STEEP {
            return None;
        }
        let highest = if scope.along_near { scope.reach * slope } else { scope.reach / lean };
        Some(Self {
            pair: *pair,
            face_a,
            face_b,
            scope: *scope,
            near_w,
            sight,
            normal_a,
            plane_b,
            lean,
            slope,
            highest,
        })
    }

    /// The vertices of A's face.
    pub fn ring_a(&self) -> &'a [VertexId] {
        self.pair.a.face_vertices(self.face_a)
    }

    /// Of those between faces and sight the least cosine.
    pub fn least_cosine(&self) -> f64 {
        self.lean.min(self.slope).min(self.sight.dot(self.normal_a))
    }

    /// The edges of A's face: see [`FacePair::ring_a`].
    pub fn edges_a(&self) -> &'a [EdgeId] {
        self.pair.a.face_edges(self.face_a)
    }

    /// The sides of B's face.
    pub fn sides_b(&self) -> &'a [Plane] {
        self.pair.b.face_sides(self.face_b)
    }

    /// Where the sight through a point meets B's plane.
    pub fn foot(&self, p: DVec3) -> DVec3 {
        p - self.sight * (self.height(p) / self.slope)
    }

    /// How high a point lies above B's plane, metres.
    pub fn height(&self, p: DVec3) -> f64 {
        self.plane_b.signed_distance(p)
    }

    /// The sides of B's face as planes along the sight: outward normals, not of unit length, and offsets.
    pub fn sides_of_b(&self) -> impl Iterator<Item = (DVec3, f64)> + use<'a> {
        let Self { plane_b, sight, slope, scope, .. } = *self;
        self.pair.b.face_sides(self.face_b).iter().map(move |side| {
            if !scope.along_near {
                return (side.normal, side.distance);
            }
            let lean = side.normal.dot(sight);
            (side.normal * slope - plane_b.normal * lean, side.distance * slope - plane_b.distance * lean)
        })
    }

    /// The point of A's face over the `j`-th vertex of B's face, if that lies under A's face and not within `same` metres of its
    /// border. `on_a` is any point of A's face.
    pub fn over_vertex_of_b(&self, j: usize, on_a: DVec3, same: f64) -> Option<DVec3> {
        let at = self.pair.b.vertex(self.pair.b.face_vertices(self.face_b)[j]);
        let span = self.normal_a.dot(on_a - at) / self.normal_a.dot(self.sight);
        if span * self.slope > self.highest {
            return None;
        }
        let point = at + self.sight * span;
        let seen = self.pair.placed.seen_from_a(point);
        self.pair.a.face_sides(self.face_a).iter().all(|s| s.signed_distance(seen) < -same).then_some(point)
    }

    /// Whether the contact region may go on in other faces beside these: any if the scope is wide, else facets of the same ones.
    pub fn may_go_on(&self) -> bool {
        let Pair { solids, part, piece, .. } = self.pair;
        self.scope.wide
            || self.scope.along_near
                && (solids.moving.is_facet(part, self.face_a) || solids.fixed.is_facet(piece, self.face_b))
    }

    /// Gives `each` the pairs of faces that meet these two at a corner, from the point of A's face there: over the corner's sides. A
    /// convex gap grows from its least place on, so that what lies in reach hangs together by corners that do.
    pub fn each_beyond(&self, corner: Corner, point: DVec3, same: f64, mut each: impl FnMut((FaceId, FaceId))) {
        let height = self.height(point);
        if height > self.highest {
            return;
        }
        let Pair { solids, a, b, part, piece, placed } = self.pair;
        let beyond_a = |side: usize| {
            let face_a = a.face_faces(self.face_a)[side];
            let goes_on = if self.scope.wide {
                (placed.r * a.face_plane(face_a).normal).dot(self.plane_b.normal) < FACING
            } else {
                is_same_face(a, self.face_a, face_a)
            };
            (goes_on && !solids.is_internal_a(part, face_a)).then_some((face_a, self.face_b))
        };
        let beyond_b = |side: usize| {
            let face_b = b.face_faces(self.face_b)[side];
            let goes_on = if self.scope.wide {
                self.normal_a.dot(b.face_plane(face_b).normal) > -FACING
            } else {
                is_same_face(b, self.face_b, face_b)
            };
            (goes_on && !solids.is_internal_b(piece, face_b)).then_some((self.face_a, face_b))
        };
        match corner {
            Corner::OfA(i) => {
                [before(i, self.ring_a().len()), i].into_iter().filter_map(beyond_a).for_each(&mut each);
                let foot = self.foot(point);
                let sides = self.sides_b().iter().enumerate();
                sides
                    .filter(|(_, s)| s.signed_distance(foot) >= -2.0 * same)
                    .filter_map(|(j, _)| beyond_b(j))
                    .for_each(each);
            }
            Corner::OfB(j) => [before(j, self.sides_b().len()), j].into_iter().filter_map(beyond_b).for_each(each),
            Corner::Crossing(i, j) => {
                beyond_a(i).into_iter().for_each(&mut each);
                let n = self.sides_b().len();
                let foot = self.foot(point);
                // An edge of A may pass over a vertex of B.
                let meets = |k: &usize| *k == j || self.sides_b()[*k].signed_distance(foot) >= -2.0 * same;
                [before(j, n), j, (j + 1) % n].into_iter().filter(meets).filter_map(beyond_b).for_each(each);
            }
        }
    }

    /// Whether the scope asks for vertices that stand past a joint, and there are joints where they may.
    pub fn may_look_past(&self) -> bool {
        !self.scope.along_near && self.pair.solids.is_hollow
    }

    /// Whether B's face, and whether A's, has such a joint: see [`FacePair::is_past_b`] and [`FacePair::past_a`].
    pub fn looks_past(&self) -> [bool; 2] {
        let Pair { solids, part, piece, .. } = self.pair;
        [solids.fixed.is_hollow(piece, self.face_b), solids.moving.is_hollow(part, self.face_a)]
    }

    /// Whether the vertex of A at `point` stands past an obtuse hollow joint at the border of B's face, no farther than the reach.
    ///
    /// Its foot then lies in the next piece, and past the joint B's face asks less than that piece does. But a step that leads back
    /// must see it before it is made: the vertex would cross the joint to and fro and never come to rest in it.
    pub fn is_past_b(&self, point: DVec3, same: f64) -> bool {
        let Pair { solids, b, piece, .. } = self.pair;
        let height = self.height(point);
        let foot = point - self.plane_b.normal * height;
        self.is_beside(height, b.face_sides(self.face_b), foot, same) && solids.fixed.is_inside_another(piece, foot)
    }

    /// The same of the `j`-th vertex of B's face past a joint of A's: the point of A's plane over it. `on_a` is any point of A's face.
    pub fn past_a(&self, j: usize, on_a: DVec3, same: f64) -> Option<DVec3> {
        let Pair { solids, a, b, part, placed, .. } = self.pair;
        let at = b.vertex(b.face_vertices(self.face_b)[j]);
        let height = self.normal_a.dot(on_a - at);
        let seen = placed.seen_from_a(at + self.normal_a * height);
        (self.is_beside(height, a.face_sides(self.face_a), seen, same) && solids.moving.is_inside_another(part, seen))
            .then(|| at + self.sight * (height / self.normal_a.dot(self.sight)))
    }

    /// Whether `foot` lies outside of the sides, but no farther than the reach, and `height` over the face is in reach, too.
    fn is_beside(&self, height: f64, sides: &[Plane], foot: DVec3, same: f64) -> bool {
        let reach = self.scope.reach;
        let out = || sides.iter().map(|s| s.signed_distance(foot)).fold(f64::NEG_INFINITY, f64::max);
        (-BELOW..=reach).contains(&height) && (same..=reach).contains(&out())
    }

    /// The basic contact at a corner of the region, from the point of A's face there. None where there is no border to touch,
    /// since a face goes on in another piece of its body, and beyond the reach.
    pub fn contact(&self, corner: Corner, point: DVec3) -> Option<RegionPoint> {
        let height = self.height(point);
        if height > self.highest {
            return None;
        }
        let foot = point - self.sight * (height / self.slope);
        // The ends of a cut are no corners of the whole face: weighted by their depths they would count as contacts, tied with a corner
        // they would be told before the whole edge ties; along their own normals, which lean where an edge of B passes over the cut,
        // they would hold what the whole face lets go.
        if self.is_cut_in_a(corner, point) || self.is_cut_in_b(corner, foot) {
            return None;
        }
        let contact = self.basic_contact(corner);
        let (point_w, normal_w, gap) = match contact {
            BasicContact::TypeB { .. } => (foot, self.plane_b.normal, height),
            BasicContact::TypeA { vertex_b, .. } => (self.pair.b.vertex(vertex_b), self.normal_a, height * self.lean),
            BasicContact::TypeC { edge_a, edge_b } => {
                let (normal_w, gap) = crossing(&self.pair, edge_a, edge_b, self.plane_b.normal, height);
                if !self.scope.along_near
                    && gap <= self.scope.reach
                    && let Corner::Crossing(i, j) = corner
                    && self.leans_away(normal_w, i, j)
                {
                    return None;
                }
                (foot, normal_w, gap)
            }
        };
        let gap = if self.scope.along_near { height / self.slope } else { gap };
        (gap <= self.scope.reach).then_some(RegionPoint { contact, sharpness: 1.0, point_w, normal_w, gap })
    }

    /// Whether the normal of two edges, of A's face and of B's, leans away from the outside of either face: then an edge rises
    /// there, what lies beside it comes first, and a corner on its way over the rim would be held back.
    fn leans_away(&self, normal_w: DVec3, i: usize, j: usize) -> bool {
        let Pair { a, b, placed, .. } = self.pair;
        normal_w.dot(b.face_sides(self.face_b)[j].normal) < -AWAY
            || normal_w.dot(self.normal_a) < 1.0 - 0.5 * AWAY * AWAY
                && normal_w.dot(placed.r * a.face_sides(self.face_a)[i].normal) > AWAY
    }

    /// The features that meet at a corner of the region.
    #[inline]
    pub fn basic_contact(&self, corner: Corner) -> BasicContact {
        let Pair { a, b, .. } = self.pair;
        let (face_a, face_b) = (self.face_a, self.face_b);
        match corner {
            Corner::OfA(i) => BasicContact::TypeB { vertex_a: self.ring_a()[i], face_b },
            Corner::OfB(j) => BasicContact::TypeA { face_a, vertex_b: b.face_vertices(face_b)[j] },
            Corner::Crossing(i, j) => {
                BasicContact::TypeC { edge_a: a.face_edges(face_a)[i], edge_b: b.face_edges(face_b)[j] }
            }
        }
    }

    /// Whether a contact of these faces, at these places on A and on B, is one that only a cut in either body makes.
    pub fn is_cut(&self, contact: BasicContact, [on_a, on_b]: [DVec3; 2]) -> bool {
        let ring_b = self.pair.b.face_vertices(self.face_b);
        let corner = match contact {
            BasicContact::TypeA { vertex_b, .. } => ring_b.iter().position(|v| *v == vertex_b).map(Corner::OfB),
            BasicContact::TypeB { vertex_a, .. } => self.ring_a().iter().position(|v| *v == vertex_a).map(Corner::OfA),
            BasicContact::TypeC { edge_a, edge_b } => {
                let i = self.edges_a().iter().position(|e| *e == edge_a);
                let j = self.pair.b.face_edges(self.face_b).iter().position(|e| *e == edge_b);
                i.zip(j).map(|(i, j)| Corner::Crossing(i, j))
            }
        };
        corner.is_some_and(|c| self.is_cut_in_a(c, on_a) || self.is_cut_in_b(c, on_b))
    }

    /// Whether A's face goes on in another part of A beyond a side that the corner lies on.
    fn is_cut_in_a(&self, corner: Corner, point: DVec3) -> bool {
        let is_cut = |side| self.pair.solids.goes_on_a(self.pair.part, self.face_a, side, point, self.pair.placed);
        match corner {
            Corner::OfA(i) => {
                let Pair { solids, part, .. } = self.pair;
                solids.moving.runs_on(part, self.face_a, i) || is_cut(i) || is_cut(before(i, self.ring_a().len()))
            }
            Corner::OfB(_) => false,
            Corner::Crossing(i, _) => is_cut(i),
        }
    }

    /// The same of B's face, for its vertex or the foot of the crossing.
    fn is_cut_in_b(&self, corner: Corner, foot: DVec3) -> bool {
        let is_cut = |side, at| self.pair.solids.goes_on_b(self.pair.piece, self.face_b, side, at);
        match corner {
            Corner::OfA(_) => false,
            Corner::OfB(j) => {
                let ring = self.pair.b.face_vertices(self.face_b);
                let at = self.pair.b.vertex(ring[j]);
                let Pair { solids, piece, .. } = self.pair;
                solids.fixed.runs_on(piece, self.face_b, j) || is_cut(before(j, ring.len()), at) || is_cut(j, at)
            }
            Corner::Crossing(_, j) => is_cut(j, foot),
        }
    }
}

/// The position before `i` in a ring of `n`.
fn before(i: usize, n: usize) -> usize {
    if i == 0 { n - 1 } else { i - 1 }
}

/// Normal and gap of two crossing edges whose vertical distance above B's face is `height`.
fn crossing(pair: &Pair<'_>, edge_a: EdgeId, edge_b: EdgeId, normal_b: DVec3, height: f64) -> (DVec3, f64) {
    let n = (pair.placed.r * pair.a.edge_direction(edge_a)).cross(pair.b.edge_direction(edge_b));
    let length = n.length();
    if length <= PARALLEL_EDGES {
        return (normal_b, height);
    }
    let lean = n.dot(normal_b) / length;
    if lean.abs() < 0.1 {
        return (normal_b, height);
    }
    (n * (lean.signum() / length), height * lean.abs())
}
