use crate::{EdgeId, FaceId, VertexId};
use serde::{Deserialize, Serialize};

/// One basic contact: a node of the contact graph (paper, section II). Ids belong to the polyhedron their name ends in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum BasicContact {
    /// A face of A against a vertex of B.
    TypeA {
        /// Face of A.
        face_a: FaceId,
        /// Vertex of B.
        vertex_b: VertexId,
    },
    /// A vertex of A against a face of B.
    TypeB {
        /// Vertex of A.
        vertex_a: VertexId,
        /// Face of B.
        face_b: FaceId,
    },
    /// An edge of A against an edge of B.
    TypeC {
        /// Edge of A.
        edge_a: EdgeId,
        /// Edge of B.
        edge_b: EdgeId,
    },
}

impl BasicContact {
    /// `'A'`, `'B'` or `'C'`.
    #[must_use]
    pub const fn type_letter(&self) -> char {
        match self {
            Self::TypeA { .. } => 'A',
            Self::TypeB { .. } => 'B',
            Self::TypeC { .. } => 'C',
        }
    }

    /// The features' indices: of A, then of B.
    #[must_use]
    pub const fn features(&self) -> (u32, u32) {
        match *self {
            Self::TypeA { face_a, vertex_b } => (face_a.0, vertex_b.0),
            Self::TypeB { vertex_a, face_b } => (vertex_a.0, face_b.0),
            Self::TypeC { edge_a, edge_b } => (edge_a.0, edge_b.0),
        }
    }

    /// The reverse of [`BasicContact::type_letter`] and [`BasicContact::features`].
    #[must_use]
    pub const fn from_parts(type_letter: char, feature_a: u32, feature_b: u32) -> Option<Self> {
        match type_letter {
            'A' => Some(Self::TypeA { face_a: FaceId(feature_a), vertex_b: VertexId(feature_b) }),
            'B' => Some(Self::TypeB { vertex_a: VertexId(feature_a), face_b: FaceId(feature_b) }),
            'C' => Some(Self::TypeC { edge_a: EdgeId(feature_a), edge_b: EdgeId(feature_b) }),
            _ => None,
        }
    }
}
