use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub struct $name(pub u32);

        impl $name {
            /// The position in the polyhedron's own arrays.
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// A face of a polyhedron (after coplanar facets were merged).
    FaceId
);
id!(
    /// An edge of a polyhedron.
    EdgeId
);
id!(
    /// A vertex of a polyhedron.
    VertexId
);

/// No edge.
pub(crate) const NO_EDGE: u32 = u32::MAX;
