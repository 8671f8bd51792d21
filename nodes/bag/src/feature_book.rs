use crate::principal_contact::{Feature, PrincipalContact};
use cspace::{EdgeId, FaceId, Polyhedron, VertexId, World};
use spatial::DVec3;
use std::sync::Arc;

/// The features of a scene's polyhedra: which of different pieces are one and the same, and which are part of others.
/// Built once per scene.
#[derive(Clone, Debug)]
pub struct FeatureBook {
    pub(crate) a: Side,
    pub(crate) b: Side,
}

impl FeatureBook {
    /// The features of `world`.
    #[must_use]
    pub fn new(world: &World) -> Self {
        let b = world.fixed.iter().map(|f| (f.obstacle, f.polyhedron.clone())).collect();
        Self { a: Side::new(world.moving.iter().map(|p| (0, p.clone())).collect()), b: Side::new(b) }
    }

    /// Whether both features of `inner` are within those of `outer`.
    pub(crate) fn is_part_of(&self, inner: &PrincipalContact, outer: &PrincipalContact) -> bool {
        self.a.is_within((inner.part_a, inner.feature_a), (outer.part_a, outer.feature_a))
            && self.b.is_within((inner.piece_b, inner.feature_b), (outer.piece_b, outer.feature_b))
    }
}

/// The polyhedra of one body or of the obstacles, in one frame.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// The body that a polyhedron is a piece of, and the polyhedron.
    pieces: Vec<(u32, Arc<Polyhedron>)>,
    /// Lengths below this are none, metres.
    tolerance: f64,
    faces: Vec<Vec<(u32, FaceId)>>,
    edges: Vec<Vec<(u32, EdgeId)>>,
    vertices: Vec<Vec<(u32, VertexId)>>,
}

impl Side {
    fn new(pieces: Vec<(u32, Arc<Polyhedron>)>) -> Self {
        let size = pieces.iter().map(|(_, p)| p.size()).fold(0.0, f64::max);
        let mut side =
            Self { pieces, tolerance: 1e-6 * size, faces: Vec::new(), edges: Vec::new(), vertices: Vec::new() };
        let faces = side.first_of_each(|p| p.faces().collect(), |s, a, b| s.is_same_plane(a, b));
        let edges = side.first_of_each(|p| p.edges().collect(), |s, a, b| s.is_same_edge(a, b));
        let vertices = side.first_of_each(
            |p| (0..p.vertices().len() as u32).map(VertexId).collect(),
            |s, a, b| s.is_same_point(s.point(a), s.point(b)),
        );
        (side.faces, side.edges, side.vertices) = (faces, edges, vertices);
        side
    }

    /// For each feature of each piece the first one of the same body that is the same.
    fn first_of_each<Id: Copy>(
        &self,
        ids: impl Fn(&Polyhedron) -> Vec<Id>,
        is_same: impl Fn(&Self, (u32, Id), (u32, Id)) -> bool,
    ) -> Vec<Vec<(u32, Id)>> {
        let mut firsts: Vec<(u32, Id)> = Vec::new();
        let mut table = Vec::new();
        for (i, (body, polyhedron)) in self.pieces.iter().enumerate() {
            let known = firsts.len();
            let mut row = Vec::new();
            for id in ids(polyhedron) {
                let this = (i as u32, id);
                // A piece has no feature twice, so only those of earlier pieces are candidates.
                let first = firsts[..known]
                    .iter()
                    .find(|f| self.pieces[f.0 as usize].0 == *body && is_same(self, **f, this))
                    .copied();
                if first.is_none() {
                    firsts.push(this);
                }
                row.push(first.unwrap_or(this));
            }
            table.push(row);
        }
        table
    }

    /// The feature that stands for this one.
    pub(crate) fn representative(&self, piece: u32, feature: Feature) -> (u32, Feature) {
        let at = piece as usize;
        let found = match feature {
            Feature::Face(f) => self.faces.get(at).and_then(|r| r.get(f.index())).map(|r| (r.0, Feature::Face(r.1))),
            Feature::Edge(e) => self.edges.get(at).and_then(|r| r.get(e.index())).map(|r| (r.0, Feature::Edge(r.1))),
            Feature::Vertex(v) => {
                self.vertices.get(at).and_then(|r| r.get(v.index())).map(|r| (r.0, Feature::Vertex(r.1)))
            }
            Feature::Unknown => None,
        };
        found.unwrap_or((piece, feature))
    }

    /// The face that looks most along `outward`, or the edge that the vertices lie on (if there is one vertex, its edge
    /// that is nearest to square to `outward`).
    pub(crate) fn complete(&self, piece: u32, wants_face: bool, vertices: &[VertexId], outward: DVec3) -> Feature {
        let Some((_, polyhedron)) = self.pieces.get(piece as usize) else { return Feature::Unknown };
        if wants_face {
            let along = |f: &FaceId| polyhedron.face_plane(*f).normal.dot(outward);
            let best = polyhedron.faces().max_by(|f, g| along(f).total_cmp(&along(g)));
            return best.map_or(Feature::Unknown, Feature::Face);
        }
        let is_vertex = |v: &&VertexId| v.index() < polyhedron.vertices().len();
        let Some(&first) = vertices.first().filter(is_vertex) else { return Feature::Unknown };
        let joins = |e: &EdgeId| vertices.iter().all(|v| polyhedron.edge(*e).vertices.contains(v));
        let slope = |e: &EdgeId| polyhedron.edge_direction(*e).dot(outward).abs();
        let candidates = polyhedron.vertex_edges(first).iter().copied().filter(joins);
        candidates.min_by(|e, f| slope(e).total_cmp(&slope(f))).map_or(Feature::Unknown, Feature::Edge)
    }

    /// Whether a feature lies in another: all its corners are on the other's plane, line or point, of the same body.
    fn is_within(&self, inner: (u32, Feature), outer: (u32, Feature)) -> bool {
        if inner == outer {
            return true;
        }
        let (Some((body, _)), Some((other, polyhedron))) =
            (self.pieces.get(inner.0 as usize), self.pieces.get(outer.0 as usize))
        else {
            return false;
        };
        let corners = self.corners(inner);
        let on = |p: DVec3| match outer.1 {
            Feature::Face(f) => polyhedron.face_plane(f).signed_distance(p).abs() <= self.tolerance,
            Feature::Edge(e) => {
                let from = p - polyhedron.vertex(polyhedron.edge(e).vertices[0]);
                from.reject_from_normalized(polyhedron.edge_direction(e).normalize()).length() <= self.tolerance
            }
            Feature::Vertex(_) | Feature::Unknown => false,
        };
        body == other && !corners.is_empty() && corners.into_iter().all(on)
    }

    /// The faces that meet in a feature, with their outward normals.
    pub(crate) fn faces_at(&self, piece: u32, feature: Feature) -> Vec<(Feature, DVec3)> {
        let Some((_, p)) = self.pieces.get(piece as usize) else { return Vec::new() };
        let faces = match feature {
            Feature::Vertex(v) if v.index() < p.vertices().len() => p.vertex_faces(v).to_vec(),
            Feature::Edge(e) if e.index() < p.edge_count() => p.edge(e).faces.to_vec(),
            Feature::Face(f) if f.index() < p.face_count() => vec![f],
            _ => Vec::new(),
        };
        faces.into_iter().map(|f| (Feature::Face(f), p.face_plane(f).normal)).collect()
    }

    /// The edge that a feature is, or those that end in it, with their directions.
    pub(crate) fn edges_at(&self, piece: u32, feature: Feature) -> Vec<(Feature, DVec3)> {
        let Some((_, p)) = self.pieces.get(piece as usize) else { return Vec::new() };
        let edges = match feature {
            Feature::Vertex(v) if v.index() < p.vertices().len() => p.vertex_edges(v).to_vec(),
            Feature::Edge(e) if e.index() < p.edge_count() => vec![e],
            _ => Vec::new(),
        };
        edges.into_iter().map(|e| (Feature::Edge(e), p.edge_direction(e).normalize_or_zero())).collect()
    }

    fn corners(&self, (piece, feature): (u32, Feature)) -> Vec<DVec3> {
        let Some((_, p)) = self.pieces.get(piece as usize) else { return Vec::new() };
        match feature {
            Feature::Vertex(v) if v.index() < p.vertices().len() => vec![p.vertex(v)],
            Feature::Edge(e) if e.index() < p.edge_count() => p.edge(e).vertices.map(|v| p.vertex(v)).to_vec(),
            Feature::Face(f) if f.index() < p.face_count() => p.face_vertices(f).iter().map(|&v| p.vertex(v)).collect(),
            _ => Vec::new(),
        }
    }

    fn point(&self, (piece, vertex): (u32, VertexId)) -> DVec3 {
        self.pieces[piece as usize].1.vertex(vertex)
    }

    fn is_same_point(&self, a: DVec3, b: DVec3) -> bool {
        a.distance(b) <= self.tolerance
    }

    fn is_same_edge(&self, a: (u32, EdgeId), b: (u32, EdgeId)) -> bool {
        let ends = |(piece, edge): (u32, EdgeId)| {
            let p = &self.pieces[piece as usize].1;
            p.edge(edge).vertices.map(|v| p.vertex(v))
        };
        let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
        (self.is_same_point(a0, b0) && self.is_same_point(a1, b1))
            || (self.is_same_point(a0, b1) && self.is_same_point(a1, b0))
    }

    fn is_same_plane(&self, a: (u32, FaceId), b: (u32, FaceId)) -> bool {
        let plane = |(piece, face): (u32, FaceId)| self.pieces[piece as usize].1.face_plane(face);
        let (a, b) = (plane(a), plane(b));
        a.normal.dot(b.normal) > 1.0 - 1e-9 && (a.distance - b.distance).abs() <= self.tolerance
    }
}
