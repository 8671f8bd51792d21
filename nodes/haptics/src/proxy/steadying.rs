//! Keeps the proxy's rounds from overshooting where contacts lean on long levers.

use crate::projection::Projection;
use crate::proxy::step::Step;
use crate::proxy::view::View;
use cspace::BasicContact;
use spatial::DVec3;

/// Most that turning is held back, as a multiple of the coupling's own stiffness.
const MOST: f64 = 10.0;
/// A round that takes back more than this part of the last one's turn, with the same contacts, overshoots.
const OVERSHOOT: f64 = 0.7;
/// So many ticks in a row with a round that overshoots are no chance.
const TICKS: u32 = 4;
/// What is left of it after an estimate that asks for less.
const KEPT: f64 = 0.9;
/// Turns smaller than this tell nothing, rad.
const NOISE: f64 = 1e-5;

/// What pushed in a round: part, piece and contact.
type Active = [Option<(u32, u32, BasicContact)>; 6];

/// How much the proxy's turning is held back from round to round.
///
/// A contact with force `f` at a distance `r` from the part's origin turns, or moves its place, with the part: to second order that
/// is a stiffness of up to `f r` beside the coupling's `k_r`, of which the linearised program knows nothing. Where it exceeds `k_r`
/// every round overshoots by more than it mends, tick for tick. A proximal term, `k_r mu` against turning away from where the proxy
/// is, has the same solution and converges for `mu` near that stiffness over `k_r`, which two rounds with the same contacts tell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Steadying {
    mu: f64,
    /// Ticks in a row that overshot, and whether this one did.
    ticks: u32,
    overshot: bool,
    /// Whether the last round did.
    over: bool,
    /// The last round's turn, what part of it was made, and what pushed.
    last: Option<(DVec3, f64, Active)>,
}

impl Steadying {
    /// A tick begins.
    pub fn begin(&mut self) {
        self.over = false;
        self.ticks = if std::mem::take(&mut self.overshot) { self.ticks + 1 } else { 0 };
    }

    /// By how much a turn that the coupling asks for is made smaller, and its stiffness greater.
    pub fn factor(&self) -> f64 {
        1.0 / (1.0 + self.mu)
    }

    /// Learns from a round whose `step` is about to be made, but for the factor `scale`.
    pub fn learn(&mut self, step: &Step, scale: f64, projection: &Projection<6>, view: &View) {
        if step.dtheta.length_squared() <= NOISE * NOISE {
            self.last = None;
            return;
        }
        let active = pushing(projection, view);
        if let Some((turn, made, before)) = self.last
            && before == active
        {
            // The error goes by the factor `1 - made (1 + c) / (1 + mu)` a round; `c` is the curvature's stiffness over `k_r`.
            let factor = step.dtheta.dot(turn) / turn.length_squared();
            let curvature = ((1.0 - factor) * (1.0 + self.mu) / made - 1.0).clamp(0.0, MOST);
            let over = factor < -OVERSHOOT;
            // A first round that is mended by the second is none: again and again it overshoots.
            self.overshot |= over && self.over;
            self.over = over;
            if self.mu > 0.0 || (self.overshot || over) && self.ticks >= TICKS {
                self.mu = curvature.max(KEPT * self.mu);
            }
            if self.mu < 0.5 {
                self.mu = 0.0;
            }
        }
        self.last = active[0].map(|_| (step.dtheta, scale, active));
    }

    /// The tick's rounds led nowhere: they were all taken back.
    pub fn led_nowhere(&mut self) {
        self.overshot = true;
    }

    /// Forgets all.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

fn pushing(projection: &Projection<6>, view: &View) -> Active {
    let mut active = Active::default();
    for (to, (row, _)) in active.iter_mut().zip(projection.active()) {
        let pair = view.pairs.iter().find(|p| (p.first..p.end).contains(&row));
        *to = pair.map(|p| (p.part, p.piece, view.points[row].contact));
    }
    active
}
