use crate::audit::AuditScratch;
use crate::pair_state::PairState;
use crate::placed::{At, Placed};
use crate::{BasicContact, Body, CFace, Polyhedron, Tracked};
use spatial::Pose;
use std::sync::Arc;

/// Tracks the contact of one pair of convex polyhedra (paper, section III): A moves, B stands in W.
///
/// A step costs the same for small and large bodies: it looks at Near's own sides, and at neighbours only where one
/// could be better. It allocates nothing and its work is bounded.
#[derive(Clone, Debug)]
pub struct Tracker {
    a: Arc<Polyhedron>,
    b: Arc<Polyhedron>,
    bodies: Arc<(Body, Body)>,
    state: PairState,
    scratch: AuditScratch,
}

impl Tracker {
    /// A tracker of A (own frame) against B (vertices in W). The first step seeds globally.
    #[must_use]
    pub fn new(a: Arc<Polyhedron>, b: Arc<Polyhedron>) -> Self {
        let bodies = Arc::new((Body::new(&a, true), Body::new(&b, false)));
        Self { a, b, bodies, state: PairState::NEW, scratch: AuditScratch::new() }
    }

    /// The moving body.
    #[must_use]
    pub fn moving(&self) -> &Arc<Polyhedron> {
        &self.a
    }

    /// The obstacle.
    #[must_use]
    pub fn fixed(&self) -> &Arc<Polyhedron> {
        &self.b
    }

    pub(crate) fn bodies(&self) -> (&Body, &Body) {
        (&self.bodies.0, &self.bodies.1)
    }

    /// Near of the last step.
    pub(crate) fn near(&self) -> Option<BasicContact> {
        self.state.is_seeded().then(|| self.state.near())
    }

    /// Forgets the past and finds the globally nearest C-face at `pose` (A in W).
    pub fn seed(&mut self, pose: &Pose) -> Tracked {
        self.state.forget();
        self.step(pose)
    }

    /// Follows A to `pose` (A in W). The pose must be finite and its quaternion of unit length.
    #[inline]
    pub fn step(&mut self, pose: &Pose) -> Tracked {
        let (a, b) = &*self.bodies;
        self.state.step(a, b, &mut self.scratch, &At::new(a, pose))
    }

    /// The local subgraph at the last pose (paper, section II.A): Near and the C-faces that share an edge with it.
    /// For pictures and tests; not needed by the step. Returns how many `out` received.
    pub fn local(&self, pose: &Pose, out: &mut [CFace]) -> usize {
        let at = At::new(&self.bodies.0, pose);
        let placed = Placed::new(&self.bodies.0, &self.bodies.1, &at);
        let mut count = 0;
        let mut push = |f: CFace| {
            if let Some(slot) = out.get_mut(count) {
                *slot = f;
                count += 1;
            }
        };
        push(placed.plane(self.state.near()));
        placed.each_neighbor(self.state.near(), |n| push(placed.plane(n)));
        count
    }
}
