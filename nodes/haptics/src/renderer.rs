//! All laws behind one interface.

use crate::depth::{DepthLaw, SCP_MARGIN};
use crate::proxy::{Coefficients, Friction, Proxy};
use crate::solid::{Sense, Solids};
use crate::{Gains, LawKind, LawOutput, RenderLaw};
use cspace::World;
use spatial::{Pose, Wrench};
use std::sync::Arc;

/// Time over which the wrench passes from one law to another, s.
const CROSSFADE: f64 = 0.05;

/// Renders contact by the law that the gains name; the law may change from tick to tick, the wrench then passes over
/// within 50 ms. Allocates at construction only.
#[derive(Debug)]
pub struct Renderer {
    solids: Solids,
    sense: Sense,
    depth_law: DepthLaw,
    proxy: Proxy,
    law: Option<LawKind>,
    /// The last valid pose of the hand.
    hip: Pose,
    /// The wrench last given and what is left of the difference between two laws.
    last: Wrench,
    step: Wrench,
    fade: f64,
}

impl Renderer {
    /// A renderer of `world`; friction by `Gains` alone.
    #[must_use]
    pub fn new(world: Arc<World>) -> Self {
        Self::with_friction(world, &[])
    }

    /// A renderer of `world` with friction coefficients for each obstacle (`FixedPart::obstacle` is the index); obstacles
    /// without one take the gains'.
    #[must_use]
    pub fn with_friction(world: Arc<World>, friction: &[Option<Coefficients>]) -> Self {
        let own = world.fixed.iter().map(|p| friction.get(p.obstacle as usize).copied().flatten()).collect::<Vec<_>>();
        let solids = Solids::new(world);
        Self {
            sense: Sense::new(solids.world.clone(), SCP_MARGIN),
            depth_law: DepthLaw::new(&solids),
            proxy: Proxy::new(&solids, Friction::new(own)),
            solids,
            law: None,
            hip: Pose::IDENTITY,
            last: Wrench::ZERO,
            step: Wrench::ZERO,
            fade: 0.0,
        }
    }

    /// What is in the scene, gaps between pieces closed that are too narrow to be meant.
    #[must_use]
    pub fn world(&self) -> &Arc<World> {
        &self.solids.world
    }
}

impl RenderLaw for Renderer {
    fn render_into(&mut self, hip: &Pose, gains: &Gains, dt: f64, out: &mut LawOutput) {
        // A pose that is none (not a number, no unit quaternion) leaves the hand where it was.
        if hip.is_valid() {
            self.hip = *hip;
        }
        let hip = &{ self.hip };
        self.sense.step(hip);
        let changed = self.law.is_some_and(|l| l != gains.law);
        let first = self.law.replace(gains.law).is_none();
        out.proxy = *hip;
        if gains.law == LawKind::Proxy {
            if changed {
                // The proxy was not followed meanwhile: it starts where the hand is.
                self.proxy.reset();
            }
            let seeded = self.proxy.follow(&self.solids, hip, gains, dt);
            out.proxy = self.proxy.pose;
            (out.wrench, out.energy) = self.proxy.pull(gains);
            out.dropped = self.proxy.view.state(&mut out.formation);
            out.depth = self.depth_law.depth(&self.solids, &self.sense.pairs, hip);
            out.reseeded = seeded && !first && !changed;
        } else {
            self.depth_law.render(&self.solids, &self.sense.pairs, hip, gains.law, gains, out);
        }
        out.changed = changed;
        out.divergent = self.sense.divergent;
        out.reseeded |= self.sense.reseeded && !first;
        if changed {
            self.step = self.last - out.wrench;
            self.fade = 1.0;
        }
        if self.fade > 0.0 {
            out.wrench = out.wrench + self.step * self.fade;
            self.fade = (self.fade - dt.max(0.0) / CROSSFADE).max(0.0);
        }
        self.last = out.wrench;
    }

    fn reset(&mut self) {
        self.sense.reset();
        self.depth_law.reset();
        self.proxy.reset();
        self.law = None;
        self.last = Wrench::ZERO;
        self.fade = 0.0;
    }
}
