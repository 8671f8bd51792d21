use crate::support_table::SupportTable;
use crate::{EdgeId, FaceId, Polyhedron, VertexId};
use spatial::DVec3;

/// Turn of A's combinatorial directions, radians: breaks every exact alignment the same way everywhere, so that the
/// cells of coplanar C-faces always tile the plane. It decides between ties only; planes and points are never turned.
pub(crate) const TIE_BREAK: f64 = 2e-13;

/// One side of a face: the line through an edge in the face's plane.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Side {
    /// In-plane unit vector, outward.
    pub out: DVec3,
    /// `out . p` on the edge.
    pub offset: f64,
    /// Tangent of half the angle between this face's normal and the neighbour's.
    pub tan_half: f64,
    /// The edge.
    pub edge: u32,
    /// The face across it.
    pub face: u32,
    /// The edge's first vertex, the face on the left.
    pub corner: u32,
}

/// One spoke of a vertex ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spoke {
    /// Unit direction to the neighbour, turned by the tie break.
    pub to: DVec3,
    /// The edge.
    pub edge: u32,
    /// The neighbour.
    pub vertex: u32,
}

/// An edge as the walk needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rod {
    /// First end point.
    pub origin: DVec3,
    /// Unit direction to the second.
    pub dir: DVec3,
    pub length: f64,
    pub vertices: [u32; 2],
    pub faces: [u32; 2],
    /// Direction turned by the tie break.
    pub dir_turned: DVec3,
}

/// A polyhedron laid out for the facet walk: what one step reads lies together. Memory O(vertices + edges + faces).
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub points: Vec<DVec3>,
    /// Plane of each face, and its normal turned by the tie break.
    pub planes: Vec<(DVec3, f64)>,
    pub normals_turned: Vec<DVec3>,
    side_start: Vec<u32>,
    sides: Vec<Side>,
    spoke_start: Vec<u32>,
    spokes: Vec<Spoke>,
    pub rods: Vec<Rod>,
    pub face_of_vertex: Vec<u32>,
    pub support: SupportTable,
    pub center: DVec3,
    pub radius: f64,
    pub inner_radius: f64,
    /// Largest distance of a vertex from the frame's origin: the lever of a rotation, metres.
    pub reach: f64,
}

impl Body {
    /// `turned`: whether this body carries the tie break (A does, B does not).
    pub(crate) fn new(p: &Polyhedron, turned: bool) -> Self {
        let axis = DVec3::new(0.361_803, 0.502_417, 0.785_291).normalize();
        // As a cross product: a quaternion's own rounding would eat so small a turn.
        let tilt = |v: DVec3| if turned { v + (axis * TIE_BREAK).cross(v) } else { v };
        let (mut side_start, mut sides) = (vec![0], Vec::new());
        for f in p.faces() {
            let n = p.face_plane(f).normal;
            let ring = p.face_vertices(f);
            for i in 0..ring.len() {
                let (a, b) = (p.vertex(ring[i]), p.vertex(ring[(i + 1) % ring.len()]));
                let out = (b - a).cross(n).normalize();
                let m = p.face_plane(p.face_faces(f)[i]).normal;
                let tan_half = (m - n).length() / (m + n).length().max(1e-300);
                sides.push(Side {
                    out,
                    offset: out.dot(a).max(out.dot(b)),
                    tan_half,
                    edge: p.face_edges(f)[i].0,
                    face: p.face_faces(f)[i].0,
                    corner: ring[i].0,
                });
            }
            side_start.push(sides.len() as u32);
        }
        let (mut spoke_start, mut spokes) = (vec![0], Vec::new());
        let mut face_of_vertex = Vec::with_capacity(p.vertex_count());
        for v in (0..p.vertex_count() as u32).map(VertexId) {
            for (e, w) in p.vertex_edges(v).iter().zip(p.vertex_vertices(v)) {
                spokes.push(Spoke { to: tilt((p.vertex(*w) - p.vertex(v)).normalize()), edge: e.0, vertex: w.0 });
            }
            spoke_start.push(spokes.len() as u32);
            face_of_vertex.push(p.vertex_faces(v).first().map_or(0, |f| f.0));
        }
        let rods = p
            .edges()
            .map(|e: EdgeId| {
                let edge = p.edge(e);
                let (a, b) = (p.vertex(edge.vertices[0]), p.vertex(edge.vertices[1]));
                let dir = (b - a).normalize();
                Rod {
                    origin: a,
                    dir,
                    length: (b - a).length(),
                    vertices: edge.vertices.map(|v| v.0),
                    faces: edge.faces.map(|f| f.0),
                    dir_turned: tilt(dir),
                }
            })
            .collect();
        let planes: Vec<_> = p.faces().map(|f: FaceId| (p.face_plane(f).normal, p.face_plane(f).distance)).collect();
        let mut body = Self {
            points: p.vertices().to_vec(),
            normals_turned: planes.iter().map(|(n, _)| tilt(*n)).collect(),
            planes,
            side_start,
            sides,
            spoke_start,
            spokes,
            rods,
            face_of_vertex,
            support: SupportTable::EMPTY,
            center: p.center(),
            radius: p.size(),
            inner_radius: p.inner_radius(),
            reach: p.corner_ids().map(|v| p.vertex(v).length()).fold(0.0, f64::max),
        };
        let first = p.corner_ids().next().map_or(0, |v| v.0);
        body.support = SupportTable::new(p.vertex_count(), first, |d, from| body.lowest(d, from, &mut 0));
        body
    }

    /// The vertex lowest along `direction` (own frame), from wherever is near. Counts the vertices it leaves.
    #[inline]
    pub(crate) fn lowest_of_all(&self, direction: DVec3, visited: &mut u32) -> u32 {
        self.lowest(direction, self.support.start(direction), visited)
    }

    #[inline]
    pub(crate) fn sides(&self, face: u32) -> &[Side] {
        let f = face as usize;
        &self.sides[self.side_start[f] as usize..self.side_start[f + 1] as usize]
    }

    #[inline]
    pub(crate) fn spokes(&self, vertex: u32) -> &[Spoke] {
        let v = vertex as usize;
        &self.spokes[self.spoke_start[v] as usize..self.spoke_start[v + 1] as usize]
    }

    /// The vertex lowest along `direction` (own frame), downhill from `from`. Counts the vertices it leaves.
    #[inline]
    pub(crate) fn lowest(&self, direction: DVec3, from: u32, visited: &mut u32) -> u32 {
        self.lowest_and_lead(direction, from, visited).0
    }

    /// The same, and the sine of the angle by which the flattest edge at that vertex rises along the direction.
    #[inline]
    pub(crate) fn lowest_and_lead(&self, direction: DVec3, mut from: u32, visited: &mut u32) -> (u32, f64) {
        // Strictly downhill on a finite set: it ends; the bound is for not-a-number.
        for _ in 0..=self.points.len() {
            let mut best = (f64::INFINITY, from);
            for s in self.spokes(from) {
                let g = direction.dot(s.to);
                if g < best.0 {
                    best = (g, s.vertex);
                }
            }
            if !(best.0 < 0.0) {
                return (from, best.0);
            }
            from = best.1;
            *visited += 1;
        }
        (from, 0.0)
    }
}
