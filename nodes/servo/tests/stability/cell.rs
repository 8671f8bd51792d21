//! One cell of the table: what is measured for a law, a grip and a time of a tick, with and without passivity control.

use crate::hand::Freedom;
use crate::press::{PRESS, Task, press};
use crate::rig::{DEVICE, Grip, HALF, Rig};
use crate::search::largest;
use cspace::World;
use haptics::{Gains, LawKind};
use servo::{MotionKind, RenderedMotion};
use std::sync::Arc;

/// Energy that counts as none, J.
pub const NO_ENERGY: f64 = 1e-6;
/// Stiffness of translation while that of rotation is looked for, N/m: soft enough for every cell.
const PRESSED: f64 = 500.0;

/// Law, hand and tick.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    pub law: LawKind,
    pub grip: Grip,
    /// s.
    pub period: f64,
    pub motion: MotionKind,
}

impl Cell {
    pub fn rig(&self) -> Rig {
        Rig { grip: self.grip, device: DEVICE, period: self.period }
    }

    /// Gains that render `stiffness` in the motion looked at.
    pub fn gains(&self, stiffness: f64, passivity: bool) -> Gains {
        let gains = Gains { law: self.law, passivity, ramp_time: 0.01, ..Gains::default() };
        match self.motion {
            MotionKind::Translation => Gains { stiffness, ..gains },
            MotionKind::Rotation => {
                // A square face that lies flat turns as stiffly as 2 F L^2 / delta under law `blended`.
                let blend_depth = 2.0 * PRESS * (2.0 * HALF).powi(2) / stiffness;
                Gains { stiffness: PRESSED, rotation_stiffness: stiffness, blend_depth, ..gains }
            }
        }
    }

    pub fn freedom(&self) -> Freedom {
        match self.motion {
            MotionKind::Translation => Freedom::Translation,
            MotionKind::Rotation => Freedom::Whole,
        }
    }

    /// What the check at start says, which knows mass and damping of device and hand and nothing of the grip's stiffness.
    pub fn predicted(&self, passivity: bool) -> f64 {
        RenderedMotion::new(&self.rig().config(&self.gains(1.0, passivity)), self.motion).largest_stiffness()
    }

    /// Up to which stiffness the check at start says that the hand is given nothing, with passivity control.
    pub fn predicted_passive(&self) -> f64 {
        let motion = RenderedMotion::new(&self.rig().config(&self.gains(1.0, true)), self.motion);
        motion.largest_passive_stiffness().unwrap_or(0.0)
    }

    /// The largest stiffness that comes to rest, and the most energy given on the way there.
    pub fn largest(&self, world: &Arc<World>, passivity: bool) -> (f64, f64) {
        let (rig, freedom) = (self.rig(), self.freedom());
        let mut energy = 0.0f64;
        let (low, high) = self.range();
        let k = largest(low, high, |k| {
            let o = press(world, &rig, &self.gains(k, passivity), freedom, Task::Press);
            if o.stable {
                energy = energy.max(o.energy);
            }
            o.stable
        });
        (k, energy)
    }

    /// The largest stiffness up to which the hand is given nothing.
    pub fn passive(&self, world: &Arc<World>, passivity: bool) -> f64 {
        let (rig, freedom) = (self.rig(), self.freedom());
        let (low, high) = self.range();
        largest(low, high, |k| {
            let gains = self.gains(k, passivity);
            let given = |task| press(world, &rig, &gains, freedom, task).energy;
            given(Task::Press) <= NO_ENERGY && given(Task::Tap) <= NO_ENERGY
        })
    }

    /// Where stiffness is looked for.
    fn range(&self) -> (f64, f64) {
        match self.motion {
            MotionKind::Translation => (100.0, 2e5),
            MotionKind::Rotation => (0.1, 200.0),
        }
    }
}
