use crate::Gains;
use spatial::{DVec3, Wrench};

/// What became of a wrench.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limited {
    /// The wrench within its limits.
    pub wrench: Wrench,
    /// Whether force or torque reached its greatest value.
    pub saturated: bool,
}

/// Keeps force and torque within their greatest values and greatest rates of change. Directions are kept by the former;
/// the latter moves on a straight line towards what is asked.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limiter {
    last: Wrench,
}

impl Limiter {
    /// One tick of `dt` seconds. What is asked must be finite.
    pub fn step(&mut self, asked: &Wrench, gains: &Gains, dt: f64) -> Limited {
        let factors = [
            limit_factor(asked.force.length_squared(), gains.max_force),
            limit_factor(asked.torque.length_squared(), gains.max_torque),
        ];
        let saturated = factors.iter().any(|f| *f < 1.0);
        let goal = Wrench::new(asked.force * factors[0], asked.torque * factors[1]);
        self.last.force += shortened(goal.force - self.last.force, gains.max_force_rate * dt);
        self.last.torque += shortened(goal.torque - self.last.torque, gains.max_torque_rate * dt);
        // When a limit was lowered, the way down is not slowed by the rate.
        self.last = clamped(&self.last, gains);
        Limited { wrench: self.last, saturated }
    }

    /// No force at once: safety does not wait for the rate.
    pub fn cut(&mut self) {
        self.last = Wrench::ZERO;
    }
}

/// The wrench with force and torque shortened to the greatest that the gains allow.
#[must_use]
pub fn clamped(wrench: &Wrench, gains: &Gains) -> Wrench {
    Wrench::new(shortened(wrench.force, gains.max_force), shortened(wrench.torque, gains.max_torque))
}

/// `v` shortened to at most `max`.
fn shortened(v: DVec3, max: f64) -> DVec3 {
    v * limit_factor(v.length_squared(), max)
}

/// The factor, 1 or less, that brings the length of which this is the square down to `max`.
#[inline]
pub(crate) fn limit_factor(square: f64, max: f64) -> f64 {
    // No root is taken of what is short enough.
    if square > max * max { max / square.sqrt() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        (-100.0..100.0, -100.0..100.0, -100.0..100.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn neither_value_nor_rate_is_ever_exceeded(
            asked in proptest::collection::vec((vector(), vector()), 1..50),
            max_force in 0.0..50.0, max_torque in 0.0..5.0, rate in 1.0..1e5, dt in 1e-4..4e-3,
        ) {
            let gains = Gains { max_force, max_torque, max_force_rate: rate, max_torque_rate: rate, ..Default::default() };
            let mut limiter = Limiter::default();
            let mut last = Wrench::ZERO;
            for (force, torque) in asked {
                let out = limiter.step(&Wrench::new(force, torque), &gains, dt);
                prop_assert!(out.wrench.force.length() <= max_force * (1.0 + 1e-12));
                prop_assert!(out.wrench.torque.length() <= max_torque * (1.0 + 1e-12));
                prop_assert!((out.wrench.force - last.force).length() <= rate * dt * (1.0 + 1e-9) + 1e-12);
                prop_assert_eq!(out.saturated, force.length() > max_force || torque.length() > max_torque);
                last = out.wrench;
            }
        }

        #[test]
        fn what_is_within_the_limits_is_reached_exactly(force in vector(), torque in vector()) {
            let wide = Gains {
                max_force: 1e3, max_torque: 1e3, max_force_rate: 1e9, max_torque_rate: 1e9, ..Default::default()
            };
            let mut limiter = Limiter::default();
            prop_assert_eq!(limiter.step(&Wrench::new(force, torque), &wide, 1e-3).wrench, Wrench::new(force, torque));
        }
    }

    #[test]
    fn a_lowered_limit_holds_at_once_and_a_cut_is_immediate() {
        let mut gains = Gains { max_force_rate: 1e9, ..Default::default() };
        let mut limiter = Limiter::default();
        limiter.step(&Wrench::new(DVec3::X * 9.0, DVec3::ZERO), &gains, 1e-3);
        gains.max_force = 2.0;
        gains.max_force_rate = 1.0;
        let out = limiter.step(&Wrench::new(DVec3::X * 9.0, DVec3::ZERO), &gains, 1e-3);
        assert!((out.wrench.force.x - 2.0).abs() < 1e-12 && out.saturated);
        limiter.cut();
        let out = limiter.step(&Wrench::ZERO, &gains, 1e-3);
        assert_eq!(out.wrench, Wrench::ZERO);
    }
}
