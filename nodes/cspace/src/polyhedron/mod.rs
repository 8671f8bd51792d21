mod build;
mod error;
mod facets;
mod plane;
#[cfg(test)]
mod tests;

pub use error::PolyhedronError;
pub use plane::Plane;

use crate::{EdgeId, FaceId, VertexId};
use spatial::{DMat3, DVec3, Pose};

/// Adjacent input faces are one face when neither bulges out of the other's plane by more than this part of the size.
pub const COPLANAR_TOLERANCE: f64 = 1e-12;
/// Dents and polygons off their plane by up to this part of the size are rounding of the file and are flattened.
pub const DENT_TOLERANCE: f64 = 1e-6;

/// An edge: its vertices and its faces. Seen from outside, walking from `vertices[0]` to `vertices[1]`, `faces[0]` is
/// on the left and `faces[1]` on the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its end points.
    pub vertices: [VertexId; 2],
    /// The faces left and right of it.
    pub faces: [FaceId; 2],
}

/// Rows of different length in one array.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows<T> {
    /// From where to where each row goes.
    spans: Vec<[u32; 2]>,
    items: Vec<T>,
}

impl<T> Rows<T> {
    pub(crate) fn new() -> Self {
        Self { spans: Vec::new(), items: Vec::new() }
    }

    pub(crate) fn push_row(&mut self, row: impl IntoIterator<Item = T>) {
        let from = self.items.len() as u32;
        self.items.extend(row);
        self.spans.push([from, self.items.len() as u32]);
    }

    #[inline]
    pub(crate) fn row(&self, i: usize) -> &[T] {
        let [from, to] = self.spans[i];
        &self.items[from as usize..to as usize]
    }
}

/// A closed convex polyhedron with coplanar facets merged into polygons, and its adjacency: the neighbourhood
/// operators of the paper's appendix are slices of flat arrays. Immutable; share it in an [`std::sync::Arc`].
///
/// Vertices keep the numbers of the input. One that is left inside a merged face or along a straight edge, or that no
/// face names, keeps its number but has no faces, edges or neighbours.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    vertices: Vec<DVec3>,
    planes: Vec<Plane>,
    edges: Vec<Edge>,
    face_vertices: Rows<VertexId>,
    face_edges: Rows<EdgeId>,
    face_faces: Rows<FaceId>,
    vertex_faces: Rows<FaceId>,
    vertex_edges: Rows<EdgeId>,
    vertex_vertices: Rows<VertexId>,
    edge_edges: Rows<EdgeId>,
    /// Unit, from first to second vertex.
    edge_directions: Vec<DVec3>,
    /// The vertices that some face uses, ascending.
    corners: Vec<VertexId>,
    face_sides: Rows<Plane>,
    center: DVec3,
    radius: f64,
    inner_radius: f64,
}

impl Polyhedron {
    /// A polyhedron from vertices (metres) and faces: triangles or planar polygons, counter-clockwise seen from
    /// outside. Adjacent coplanar faces are merged ([`COPLANAR_TOLERANCE`]); vertices at the same place are one, under
    /// the lowest number.
    ///
    /// # Errors
    /// If the surface is not closed, convex, oriented, finite and thick; the error names the face or the vertex.
    pub fn from_faces(vertices: &[DVec3], faces: &[Vec<u32>]) -> Result<Self, PolyhedronError> {
        build::build(vertices, faces)
    }

    /// The vertices, metres, own frame.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// One vertex, metres, own frame.
    #[inline]
    #[must_use]
    pub fn vertex(&self, v: VertexId) -> DVec3 {
        self.vertices[v.index()]
    }

    /// Number of vertices, unused ones included.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Number of faces after merging.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.planes.len()
    }

    /// Number of edges after merging.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// All faces.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (0..self.planes.len() as u32).map(FaceId)
    }

    /// All edges.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + use<> {
        (0..self.edges.len() as u32).map(EdgeId)
    }

    /// All vertices that some face uses.
    pub fn corner_ids(&self) -> impl Iterator<Item = VertexId> + '_ {
        self.corners.iter().copied()
    }

    /// The plane of a face.
    #[inline]
    #[must_use]
    pub fn face_plane(&self, f: FaceId) -> Plane {
        self.planes[f.index()]
    }

    /// An edge's vertices and faces.
    #[inline]
    #[must_use]
    pub fn edge(&self, e: EdgeId) -> Edge {
        self.edges[e.index()]
    }

    /// Unit direction of an edge from its first to its second vertex.
    #[inline]
    #[must_use]
    pub fn edge_direction(&self, e: EdgeId) -> DVec3 {
        self.edge_directions[e.index()]
    }

    /// What follows from vertices and planes and is asked for all the time.
    fn find_directions(&mut self) {
        let direction = |e: &Edge| (self.vertex(e.vertices[1]) - self.vertex(e.vertices[0])).normalize();
        self.edge_directions = self.edges.iter().map(direction).collect();
        let mut sides = Rows::new();
        for f in self.faces() {
            let (ring, across) = (self.face_vertices(f), self.face_plane(f).normal);
            sides.push_row((0..ring.len()).map(|i| {
                let (a, b) = (self.vertex(ring[i]), self.vertex(ring[(i + 1) % ring.len()]));
                let normal = (b - a).cross(across).normalize();
                Plane { normal, distance: normal.dot(a).max(normal.dot(b)) }
            }));
        }
        self.face_sides = sides;
    }

    /// `N_v(F)` of the appendix, counter-clockwise seen from outside.
    #[inline]
    #[must_use]
    pub fn face_vertices(&self, f: FaceId) -> &[VertexId] {
        self.face_vertices.row(f.index())
    }

    /// `N_e(F)`: edge `i` leads from vertex `i` of [`Polyhedron::face_vertices`] to the next.
    #[inline]
    #[must_use]
    pub fn face_edges(&self, f: FaceId) -> &[EdgeId] {
        self.face_edges.row(f.index())
    }

    /// The planes that cut the face out of its own, one through each edge of [`Polyhedron::face_edges`]: across the face's
    /// plane, their normals pointing out of the face.
    #[inline]
    #[must_use]
    pub fn face_sides(&self, f: FaceId) -> &[Plane] {
        self.face_sides.row(f.index())
    }

    /// `N_f(F)`: face `i` is the one across edge `i` of [`Polyhedron::face_edges`].
    #[inline]
    #[must_use]
    pub fn face_faces(&self, f: FaceId) -> &[FaceId] {
        self.face_faces.row(f.index())
    }

    /// `N_f(V)`, counter-clockwise seen from outside: face `i` lies between edges `i` and `i + 1` of
    /// [`Polyhedron::vertex_edges`].
    #[inline]
    #[must_use]
    pub fn vertex_faces(&self, v: VertexId) -> &[FaceId] {
        self.vertex_faces.row(v.index())
    }

    /// `N_e(V)`, counter-clockwise seen from outside.
    #[inline]
    #[must_use]
    pub fn vertex_edges(&self, v: VertexId) -> &[EdgeId] {
        self.vertex_edges.row(v.index())
    }

    /// `N_v(V)`: vertex `i` is the other end of edge `i` of [`Polyhedron::vertex_edges`].
    #[inline]
    #[must_use]
    pub fn vertex_vertices(&self, v: VertexId) -> &[VertexId] {
        self.vertex_vertices.row(v.index())
    }

    /// `N_e(E)`: the edges that share a vertex with `e`.
    #[must_use]
    pub fn edge_edges(&self, e: EdgeId) -> &[EdgeId] {
        self.edge_edges.row(e.index())
    }

    /// A point well inside, metres, own frame.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Radius of a ball about [`Polyhedron::center`] that holds the body, metres.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.radius
    }

    /// Radius of a ball about [`Polyhedron::center`] that the body holds, metres.
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        self.inner_radius
    }

    /// The same body scaled by `scale > 0` and then moved by `pose` (`pose` maps this frame to the new one).
    #[must_use]
    pub fn transformed(&self, pose: &Pose, scale: f64) -> Self {
        let r: DMat3 = pose.rotation_matrix();
        let mut out = self.clone();
        for v in &mut out.vertices {
            *v = pose.translation + r * (*v * scale);
        }
        for (f, p) in out.planes.iter_mut().enumerate() {
            p.normal = (r * p.normal).normalize();
            let mut distance = f64::NEG_INFINITY;
            for v in self.face_vertices.row(f) {
                distance = distance.max(p.normal.dot(out.vertices[v.index()]));
            }
            p.distance = distance;
        }
        out.find_directions();
        out.center = pose.translation + r * (self.center * scale);
        out.radius = self.radius * scale;
        out.inner_radius = self.inner_radius * scale;
        out
    }

    /// Whether the point (metres, own frame) lies inside or within `margin` metres of every face's plane.
    #[must_use]
    pub fn contains(&self, p: DVec3, margin: f64) -> bool {
        self.planes.iter().all(|f| f.signed_distance(p) <= margin)
    }

    /// The vertex farthest along `direction` (own frame), by looking at all of them.
    #[must_use]
    pub fn support(&self, direction: DVec3) -> VertexId {
        let mut best = (f64::NEG_INFINITY, VertexId(0));
        for v in &self.corners {
            let h = direction.dot(self.vertices[v.index()]);
            if h > best.0 {
                best = (h, *v);
            }
        }
        best.1
    }
}
