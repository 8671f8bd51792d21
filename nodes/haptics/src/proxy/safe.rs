//! Where the proxy may always go back to.

use spatial::Pose;

/// Energy that is none, J.
const NOTHING: f64 = 1e-9;

/// A pose of the proxy that penetrates nothing, and the coupling's energy there, J.
///
/// Obstacles stand still: a proxy that stays where it was takes exactly the hand's work. One that moves must not store more than
/// that, or the hand would get the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Safe {
    pub pose: Pose,
    energy: f64,
    /// What the coupling may hold at the end of the tick, J.
    pub most: f64,
}

impl Safe {
    /// Keeps `pose`, where the coupling holds `energy` (J), if that is the least so far in this tick; `dragged` if friction pulls.
    pub fn keep_best(kept: &mut Option<Self>, pose: &Pose, energy: f64, dragged: bool) {
        match kept {
            Some(best) if energy >= best.energy => {}
            // Friction stops the proxy before the least energy.
            Some(best) if dragged => *best = Self { pose: *pose, energy, ..*best },
            _ => *kept = Some(Self { pose: *pose, energy, most: energy + NOTHING }),
        }
    }
}
