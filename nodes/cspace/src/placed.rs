use crate::{BasicContact, Body, CFace};
use spatial::{DMat3, DVec3, Pose};

/// A pose of A, and what every pair with A needs of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At<'p> {
    pub pose: &'p Pose,
    /// `w_from_a`.
    pub r: DMat3,
    /// A's centre in W, metres.
    pub center: DVec3,
}

impl<'p> At<'p> {
    #[inline]
    pub(crate) fn new(a: &Body, pose: &'p Pose) -> Self {
        let r = pose.rotation_matrix();
        Self { pose, r, center: r * a.center + pose.translation }
    }
}

/// Two bodies at a pose of A.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub a: &'a Body,
    pub b: &'a Body,
    pub at: &'a At<'a>,
}

impl<'a> Placed<'a> {
    #[inline]
    pub(crate) fn new(a: &'a Body, b: &'a Body, at: &'a At<'a>) -> Self {
        Self { a, b, at }
    }

    /// Length below which ties are kept as they are, metres.
    #[inline]
    pub(crate) fn eps(&self) -> f64 {
        2e-13 * (self.a.radius + self.b.radius) + 1e-15 * (self.a.reach + self.b.reach)
    }

    /// The position of A's frame in W, metres.
    #[inline]
    pub(crate) fn x(&self) -> DVec3 {
        self.at.pose.translation
    }

    /// From A's axes to W's.
    #[inline]
    pub(crate) fn turn_to_w(&self, v: DVec3) -> DVec3 {
        self.at.r * v
    }

    /// From W's axes to A's.
    #[inline]
    pub(crate) fn turn_to_a(&self, v: DVec3) -> DVec3 {
        self.at.r.mul_transpose_vec3(v)
    }

    /// A point of A in W, metres.
    #[inline]
    pub(crate) fn point_in_w(&self, p: DVec3) -> DVec3 {
        self.x() + self.turn_to_w(p)
    }

    /// A point of W in A's frame, metres.
    #[inline]
    pub(crate) fn point_in_a(&self, p: DVec3) -> DVec3 {
        self.turn_to_a(p - self.x())
    }

    /// The plane of an applicable node.
    pub(crate) fn plane(&self, node: BasicContact) -> CFace {
        let (normal_w, distance) = match node {
            BasicContact::TypeB { vertex_a, face_b } => {
                let (n, d) = self.b.planes[face_b.index()];
                (n, n.dot(self.point_in_w(self.a.points[vertex_a.index()])) - d)
            }
            BasicContact::TypeA { face_a, vertex_b } => {
                let (n, d) = self.a.planes[face_a.index()];
                (-self.turn_to_w(n), n.dot(self.point_in_a(self.b.points[vertex_b.index()])) - d)
            }
            BasicContact::TypeC { edge_a, edge_b } => match self.crossing(edge_a.0, edge_b.0) {
                Some(c) => (c.normal, c.normal.dot(self.between_edges(edge_a.0, edge_b.0))),
                None => (DVec3::Z, f64::NEG_INFINITY),
            },
        };
        CFace { contact: node, normal_w, distance }
    }

    /// From the first end of B's edge to the first end of A's, metres, W.
    #[inline]
    pub(crate) fn between_edges(&self, edge_a: u32, edge_b: u32) -> DVec3 {
        self.point_in_w(self.a.rods[edge_a as usize].origin) - self.b.rods[edge_b as usize].origin
    }
}
