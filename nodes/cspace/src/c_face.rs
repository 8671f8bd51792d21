use crate::{BasicContact, FaceId, Polyhedron, VertexId};
use spatial::{DMat3, DQuat, DVec3, Pose};

/// A C-face at the present orientation: a basic contact and its supporting plane in C-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CFace {
    /// The basic contact that takes place on it.
    pub contact: BasicContact,
    /// Outward unit normal, axes of W.
    pub normal_w: DVec3,
    /// Signed distance of `x` to the plane `n.x = d`, metres; `< 0` inside the C-obstacle's half-space.
    pub distance: f64,
}

/// Relative length of a cross product of unit vectors below which two edges count as parallel.
const PARALLEL: f64 = 1e-12;

impl CFace {
    /// The plane of `contact` at `pose` (A in W; B's vertices are in W), whether or not it is applicable there. The
    /// sign of a type-C normal is that of the arc between the two faces of `edge_b`; parallel edges take its middle.
    #[must_use]
    pub fn at(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, pose: &Pose) -> Self {
        Self::at_turned(contact, a, b, pose.translation, &pose.rotation_matrix())
    }

    /// The same where A's origin is `x` (metres, W) and its axes are the columns of `r`.
    #[must_use]
    pub fn at_turned(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, x: DVec3, r: &DMat3) -> Self {
        let (normal_w, distance) = match contact {
            BasicContact::TypeA { face_a, vertex_b } => {
                let plane = a.face_plane(face_a);
                let b_in_a = r.transpose() * (b.vertex(vertex_b) - x);
                (-(*r * plane.normal), plane.signed_distance(b_in_a))
            }
            BasicContact::TypeB { vertex_a, face_b } => {
                let plane = b.face_plane(face_b);
                (plane.normal, plane.signed_distance(x + *r * a.vertex(vertex_a)))
            }
            BasicContact::TypeC { edge_a, edge_b } => {
                let normal = edge_normal(contact, a, b, r);
                let on_a = x + *r * a.vertex(a.edge(edge_a).vertices[0]);
                (normal, normal.dot(on_a - b.vertex(b.edge(edge_b).vertices[0])))
            }
        };
        Self { contact, normal_w, distance }
    }
}

/// Outward normal of a type-C contact (paper, section II; sign by the Gauss arcs).
fn edge_normal(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, r: &DMat3) -> DVec3 {
    let BasicContact::TypeC { edge_a, edge_b } = contact else { return DVec3::ZERO };
    let [f, g] = b.edge(edge_b).faces;
    let middle = b.face_plane(f).normal + b.face_plane(g).normal;
    let across = (*r * a.edge_direction(edge_a)).cross(b.edge_direction(edge_b));
    let length = across.length();
    if length < PARALLEL {
        return middle.normalize();
    }
    across * (if across.dot(middle) < 0.0 { -1.0 } else { 1.0 } / length)
}

/// Whether the contact can take place at this orientation of A (Donald 1985; paper, section II): touching without
/// the bodies overlapping near the contact. Ties (parallel edges and faces) count as applicable for types A and B and
/// not for type C.
#[must_use]
pub fn is_applicable(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, rotation: DQuat) -> bool {
    is_applicable_turned(contact, a, b, &DMat3::from_quat(rotation))
}

/// The same where A's axes are the columns of `r`.
#[must_use]
pub fn is_applicable_turned(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, r: &DMat3) -> bool {
    match contact {
        BasicContact::TypeA { face_a, vertex_b } => {
            let n = -(*r * a.face_plane(face_a).normal);
            supports(b, vertex_b, n)
        }
        BasicContact::TypeB { vertex_a, face_b } => {
            let n = r.transpose() * b.face_plane(face_b).normal;
            supports(a, vertex_a, -n)
        }
        BasicContact::TypeC { edge_a, edge_b } => {
            let (u, v) = (*r * a.edge_direction(edge_a), b.edge_direction(edge_b));
            if u.cross(v).length() < PARALLEL {
                return false;
            }
            let ([f, g], [h, k]) = (b.edge(edge_b).faces, a.edge(edge_a).faces);
            let n = [b.face_plane(f).normal, b.face_plane(g).normal];
            let p = [n[0].dot(u), n[1].dot(u)];
            if !(p[0] * p[1] < 0.0) {
                return false;
            }
            let m = [-(*r * a.face_plane(h).normal), -(*r * a.face_plane(k).normal)];
            let q = [m[0].dot(v), m[1].dot(v)];
            // The arcs separate each other's ends, and they do so in the same hemisphere: antipodal arcs pass the
            // first two tests as well.
            let crossing = (n[0] * p[1].abs() + n[1] * p[0].abs()).dot(m[0] * q[1].abs() + m[1] * q[0].abs());
            q[0] * q[1] < 0.0 && crossing > 0.0
        }
    }
}

/// Whether no neighbour of `v` lies farther along `direction` (own frame), but for rounding.
fn supports(p: &Polyhedron, v: VertexId, direction: DVec3) -> bool {
    let ring = p.vertex_vertices(v);
    !ring.is_empty() && ring.iter().all(|w| direction.dot(p.vertex(*w) - p.vertex(v)) <= 1e-14 * p.size())
}

/// The application point App_k of a basic contact at `pose`, metres, W: the vertex, or the point of B's edge nearest
/// to A's edge (the middle of B's edge if they are parallel).
#[must_use]
pub fn contact_point(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, pose: &Pose) -> DVec3 {
    contact_point_turned(contact, a, b, pose.translation, &pose.rotation_matrix())
}

/// The same where A's origin is `x` (metres, W) and its axes are the columns of `r`.
#[must_use]
pub fn contact_point_turned(contact: BasicContact, a: &Polyhedron, b: &Polyhedron, x: DVec3, r: &DMat3) -> DVec3 {
    match contact {
        BasicContact::TypeA { vertex_b, .. } => b.vertex(vertex_b),
        BasicContact::TypeB { vertex_a, .. } => x + *r * a.vertex(vertex_a),
        BasicContact::TypeC { edge_a, edge_b } => {
            let ([a0, a1], [b0, b1]) = (a.edge(edge_a).vertices, b.edge(edge_b).vertices);
            let (a0, a1) = (x + *r * a.vertex(a0), x + *r * a.vertex(a1));
            let (b0, b1) = (b.vertex(b0), b.vertex(b1));
            let (u, v, w) = (a1 - a0, b1 - b0, b0 - a0);
            let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
            let sine2 = uu * vv - uv * uv;
            let t = if sine2 > PARALLEL * PARALLEL * uu * vv {
                ((uv * u.dot(w) - uu * v.dot(w)) / sine2).clamp(0.0, 1.0)
            } else {
                0.5
            };
            b0 + v * t
        }
    }
}

/// All applicable C-faces at `pose`, by trying every node of the graph: the reference for tests and pictures,
/// O(|A| |B|).
#[must_use]
pub fn applicable_c_faces(a: &Polyhedron, b: &Polyhedron, pose: &Pose) -> Vec<CFace> {
    crate::ContactGraph::new(a, b)
        .nodes()
        .filter(|c| is_applicable(*c, a, b, pose.rotation))
        .map(|c| CFace::at(c, a, b, pose))
        .collect()
}

/// The type-A contact of these ids.
pub(crate) const fn type_a(face_a: u32, vertex_b: u32) -> BasicContact {
    BasicContact::TypeA { face_a: FaceId(face_a), vertex_b: VertexId(vertex_b) }
}

/// The type-B contact of these ids.
pub(crate) const fn type_b(vertex_a: u32, face_b: u32) -> BasicContact {
    BasicContact::TypeB { vertex_a: VertexId(vertex_a), face_b: FaceId(face_b) }
}

/// The type-C contact of these ids.
pub(crate) const fn type_c(edge_a: u32, edge_b: u32) -> BasicContact {
    BasicContact::TypeC { edge_a: crate::EdgeId(edge_a), edge_b: crate::EdgeId(edge_b) }
}
