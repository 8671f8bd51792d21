//! Between law and hand: the damping half of the virtual coupling, passivity, limits, and where the sampled loop is stable.

mod limiter;
mod passivity;
mod sampled_loop;

pub use limiter::{Limited, Limiter, clamped};
pub use passivity::{Displacement, Held, Passivity, PassivityLimits, returnable_energy};
pub use sampled_loop::{HoldDamping, SampledLoop};

use crate::{Gains, LawKind, LawOutput};
use spatial::{DVec3, Pose, Twist, Wrench};

/// Depth over which the rotational damping of the laws without a rotational proxy comes in, metres: contact begins
/// without a jump of the torque.
const ONSET: f64 = 5e-5;

/// Squares of rates below this are rest: a filter that runs out into denormal numbers is slow.
const TINY: f64 = 1e-30;

/// The damping half of the virtual coupling between the hand and the proxy. Its spring is the law's own wrench.
///
/// What is damped is the rate at which the coupling stretches, not the hand: sliding along a face and moving freely
/// cost nothing, and the force is continuous where contact begins.
#[derive(Clone, Copy, Debug, Default)]
pub struct Coupling {
    /// Stretch of the last tick: metres and rotation vector, proxy to hand, axes of W.
    last: Option<(DVec3, DVec3)>,
    /// Low-passed rate of stretch, m/s and rad/s.
    rate: (DVec3, DVec3),
}

impl Coupling {
    /// The damping wrench on the hand, N and N.m about A's origin, at pose `hip` moving with `twist`; `cutoff` is the
    /// corner frequency of the rate, Hz.
    pub fn damping(
        &mut self,
        law: &LawOutput,
        hip: &Pose,
        twist: &Twist,
        gains: &Gains,
        dt: f64,
        cutoff: f64,
    ) -> Wrench {
        let stretch = (hip.translation - law.proxy.translation, law.proxy.rotation_to(hip));
        let last = self.last.replace(stretch).unwrap_or(stretch);
        if law.reseeded {
            // The proxy was put elsewhere: that is no motion.
            self.rate = (DVec3::ZERO, DVec3::ZERO);
            return Wrench::ZERO;
        }
        // Another law has its proxy elsewhere: that is no motion either, and the hand goes on as it did.
        let share = if law.changed { 0.0 } else { low_pass_share(cutoff, dt) };
        let frequency = 1.0 / dt;
        self.rate.0 += ((stretch.0 - last.0) * frequency - self.rate.0) * share;
        self.rate.1 += ((stretch.1 - last.1) * frequency - self.rate.1) * share;
        if self.rate.0.length_squared() < TINY && stretch.0 == last.0 {
            self.rate.0 = DVec3::ZERO;
        }
        if self.rate.1.length_squared() < TINY && stretch.1 == last.1 {
            self.rate.1 = DVec3::ZERO;
        }
        if law.depth <= 0.0 && stretch.0 == DVec3::ZERO && stretch.1 == DVec3::ZERO {
            // Nothing is stretched: no use to let the filter run out into ever smaller numbers.
            self.rate = (DVec3::ZERO, DVec3::ZERO);
            return Wrench::ZERO;
        }
        let turn = match gains.law {
            LawKind::Proxy => self.rate.1,
            _ => twist.angular * (law.depth / ONSET).min(1.0),
        };
        Wrench::new(self.rate.0 * -gains.damping, turn * -gains.rotation_damping)
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

/// The share of a new value in a first-order low-pass of corner frequency `cutoff` (Hz) over a step of `dt` seconds.
#[must_use]
pub fn low_pass_share(cutoff: f64, dt: f64) -> f64 {
    let x = std::f64::consts::TAU * cutoff * dt;
    x / (1.0 + x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(proxy: Pose, depth: f64) -> LawOutput {
        LawOutput { depth, ..LawOutput::free(proxy) }
    }

    fn at(p: DVec3) -> Pose {
        Pose::new(p, Pose::IDENTITY.rotation)
    }

    #[test]
    fn free_motion_and_sliding_cost_nothing_and_pressing_is_damped() {
        let gains = Gains { damping: 2.0, ..Default::default() };
        let mut free = Coupling::default();
        let mut slide = Coupling::default();
        let mut press = Coupling::default();
        let mut last = Wrench::ZERO;
        for i in 0..200 {
            let d = f64::from(i) * 1e-4;
            let w = free.damping(&output(at(DVec3::X * d), 0.0), &at(DVec3::X * d), &Twist::ZERO, &gains, 1e-3, 150.0);
            assert_eq!(w, Wrench::ZERO);
            let (hip, proxy) = (at(DVec3::new(d, 0.0, -0.01)), at(DVec3::X * d));
            let w = slide.damping(&output(proxy, 0.01), &hip, &Twist::ZERO, &gains, 1e-3, 150.0);
            assert!(w.force.length() < 1e-12);
            let hip = at(DVec3::NEG_Z * d);
            last = press.damping(&output(Pose::IDENTITY, d), &hip, &Twist::ZERO, &gains, 1e-3, 150.0);
        }
        // 0.1 m/s into the wall.
        assert!((last.force - DVec3::Z * 0.2).length() < 1e-6, "{last:?}");
    }

    #[test]
    fn a_proxy_that_is_put_elsewhere_gives_no_kick() {
        let gains = Gains { damping: 2.0, ..Default::default() };
        let mut c = Coupling::default();
        c.damping(&output(at(DVec3::ZERO), 0.0), &at(DVec3::ZERO), &Twist::ZERO, &gains, 1e-3, 150.0);
        let jumped = LawOutput { reseeded: true, ..output(at(DVec3::Z), 1.0) };
        assert_eq!(c.damping(&jumped, &at(DVec3::ZERO), &Twist::ZERO, &gains, 1e-3, 150.0), Wrench::ZERO);
        let after = c.damping(&output(at(DVec3::Z), 1.0), &at(DVec3::ZERO), &Twist::ZERO, &gains, 1e-3, 150.0);
        assert_eq!(after.force, DVec3::ZERO);
    }

    #[test]
    fn another_law_whose_proxy_is_elsewhere_leaves_the_damping_as_it_was() {
        let gains = Gains { damping: 2.0, ..Default::default() };
        let mut c = Coupling::default();
        let mut damp =
            |law: &LawOutput, d: f64| c.damping(law, &at(DVec3::NEG_Z * d), &Twist::ZERO, &gains, 1e-3, 150.0).force;
        let mut before = DVec3::ZERO;
        for i in 0..200 {
            before = damp(&output(Pose::IDENTITY, 1.0), f64::from(i) * 1e-4);
        }
        let moved = LawOutput { changed: true, ..output(at(DVec3::Z * 0.01), 1.0) };
        assert_eq!(damp(&moved, 200.0 * 1e-4), before);
    }
}
