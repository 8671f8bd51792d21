/// Why vertices and faces are not a closed convex polyhedron. Indices are those of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolyhedronError {
    /// No vertices or no faces.
    #[error("no vertices or no faces: nothing to make a polyhedron of")]
    Empty,
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// Index into the input's vertices.
        vertex: usize,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {count} vertices (counted from 0)")]
    IndexOutOfRange {
        /// Index into the input's faces.
        face: usize,
        /// The index it names.
        vertex: usize,
        /// How many vertices there are.
        count: usize,
    },
    /// A face has fewer than three different vertices or no area.
    #[error("face {face} has no area: it needs three different vertices that are not on one line")]
    DegenerateFace {
        /// Index into the input's faces.
        face: usize,
    },
    /// A polygon's vertices do not lie in one plane.
    #[error("face {face} is not planar: vertex {vertex} is off its plane; split it into triangles")]
    NotPlanar {
        /// Index into the input's faces.
        face: usize,
        /// The vertex that is off the plane.
        vertex: usize,
    },
    /// An edge has a face on one side only.
    #[error("the surface is open at face {face}: nothing closes its edge between vertices {from} and {to}")]
    Open {
        /// Index into the input's faces.
        face: usize,
        /// First vertex of the edge.
        from: usize,
        /// Second vertex of the edge.
        to: usize,
    },
    /// Two faces run along an edge in the same direction, or more than two meet there.
    #[error("face {face} and its neighbour disagree about the outside at the edge between vertices {from} and {to}")]
    NotOriented {
        /// Index into the input's faces.
        face: usize,
        /// First vertex of the edge.
        from: usize,
        /// Second vertex of the edge.
        to: usize,
    },
    /// The faces are wound clockwise seen from outside.
    #[error("face {face} and all others point inwards: wind the faces counter-clockwise seen from outside")]
    InsideOut {
        /// Index into the input's faces.
        face: usize,
    },
    /// No thickness.
    #[error("face {face}: the body is flat, it has no thickness above this face")]
    Flat {
        /// Index into the input's faces: the largest one.
        face: usize,
    },
    /// Not convex.
    #[error("not convex: vertex {vertex} is outside the plane of face {face}; decompose the part or take its hull")]
    NotConvex {
        /// Index into the input's faces.
        face: usize,
        /// Index into the input's vertices.
        vertex: usize,
    },
    /// Several bodies, a body with a hole, or a pinched surface.
    #[error("face {face} does not belong to one closed surface of a single body")]
    NotOneBody {
        /// Index into the input's faces.
        face: usize,
    },
}

impl PolyhedronError {
    /// The input face at fault, if it is one.
    #[must_use]
    pub const fn face(&self) -> Option<usize> {
        match *self {
            Self::Empty | Self::NotFinite { .. } => None,
            Self::IndexOutOfRange { face, .. }
            | Self::DegenerateFace { face }
            | Self::NotPlanar { face, .. }
            | Self::Open { face, .. }
            | Self::NotOriented { face, .. }
            | Self::InsideOut { face }
            | Self::Flat { face }
            | Self::NotConvex { face, .. }
            | Self::NotOneBody { face } => Some(face),
        }
    }

    /// The input vertex at fault, if it is one alone.
    #[must_use]
    pub const fn vertex(&self) -> Option<usize> {
        match *self {
            Self::NotFinite { vertex } => Some(vertex),
            _ => None,
        }
    }
}
