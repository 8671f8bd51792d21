//! What is measured in a cell, without or with the controller.

use crate::cell::Cell;
use crate::press::{Task, press};
use cspace::World;
use haptics::LawKind;
use servo::MotionKind;
use std::sync::Arc;

/// What is said and what is found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// Largest stiffness that comes to rest, N/m or N.m/rad, in the simulation and by the start-up check.
    pub largest: f64,
    pub predicted: f64,
    /// Largest stiffness up to which neither pressing nor tapping ever gives the hand more than `NO_ENERGY`.
    pub passive: f64,
    /// The same by the start-up check; only with the controller.
    pub passive_predicted: f64,
    /// The most energy that the hand was ever given at stiffnesses that come to rest, J.
    pub energy: f64,
    /// Torque at rest under the default gains, from peak to peak, N.m, and whether it rests.
    pub torque: f64,
    pub rests: bool,
}

impl Found {
    /// Simulates a cell without or with passivity control.
    pub fn in_cell(cell: &Cell, world: &Arc<World>, passivity: bool) -> Self {
        let rocking = cell.motion == MotionKind::Rotation;
        // Laws whose torque has no stiffness to choose are only looked at as they are.
        let fixed = rocking && matches!(cell.law, LawKind::Paper | LawKind::Pstar);
        let one = press(world, &cell.rig(), &cell.gains(1.0, passivity), cell.freedom(), Task::Press);
        let (largest, energy) = if fixed { (f64::NAN, one.energy) } else { cell.largest(world, passivity) };
        Self {
            largest,
            predicted: cell.predicted(passivity),
            passive: if rocking { f64::NAN } else { cell.passive(world, passivity) },
            passive_predicted: if passivity { cell.predicted_passive() } else { f64::NAN },
            energy,
            torque: one.torque,
            rests: one.stable,
        }
    }
}
