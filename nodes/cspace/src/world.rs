use crate::Polyhedron;
use std::sync::Arc;

/// What moves and what stands, as convex polyhedra. Immutable, shared by tracker, laws and pictures.
#[derive(Clone, Debug)]
pub struct World {
    /// The convex parts of A, each in A's own frame, metres.
    pub moving: Vec<Arc<Polyhedron>>,
    /// The convex pieces of all obstacles, each in W, metres.
    pub fixed: Vec<FixedPart>,
}

/// One convex piece of an obstacle.
#[derive(Clone, Debug)]
pub struct FixedPart {
    /// The piece, vertices in W, metres.
    pub polyhedron: Arc<Polyhedron>,
    /// Which entry of the scene's `fixed` list it is a piece of.
    pub obstacle: u32,
}
