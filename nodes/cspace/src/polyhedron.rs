//! Placeholder module so that the crate's signatures compile; see `Polyhedron`.
use spatial::DVec3;

/// A closed convex polyhedron.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    vertices: Vec<DVec3>,
}

impl Polyhedron {
    /// The vertices, metres.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }
}
