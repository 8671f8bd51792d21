use haptics::Gains;

/// Time constant with which gains follow a change, s.
const TIME: f64 = 0.05;
/// Below this share of the target the rest is taken in one step, so that a ramp ends.
const NEAR: f64 = 1e-6;

/// Lets gains that are changed while it runs come in smoothly. The law and the passivity switch change at once: the
/// renderer passes from one law to another by itself. Limits come up smoothly and down at once.
#[derive(Clone, Copy, Debug, Default)]
pub struct GainRamp {
    current: Option<Gains>,
}

impl GainRamp {
    /// The gains of this tick, `dt` seconds after the last.
    pub fn step(&mut self, target: &Gains, dt: f64) -> Gains {
        let Some(mut g) = self.current else {
            self.current = Some(*target);
            return *target;
        };
        if g != *target {
            let share = dt / (TIME + dt);
            let t = target;
            // What the torque goes by is how many times its old value a blend depth is, so its way up is a growth.
            let growing = |depth: f64| if depth > 0.0 { 2.0 * depth } else { f64::INFINITY };
            let blend_depth = t.blend_depth.min(growing(g.blend_depth));
            for (value, to) in [
                (&mut g.stiffness, t.stiffness),
                (&mut g.damping, t.damping),
                (&mut g.rotation_stiffness, t.rotation_stiffness),
                (&mut g.rotation_damping, t.rotation_damping),
                (&mut g.blend_depth, blend_depth),
                (&mut g.max_force, t.max_force),
                (&mut g.max_torque, t.max_torque),
                (&mut g.friction_static, t.friction_static),
                (&mut g.friction_kinetic, t.friction_kinetic),
                (&mut g.proxy_speed, t.proxy_speed),
            ] {
                let step = (to - *value) * share;
                // Infinite is a value of its own.
                let finite = step.is_finite();
                *value = if finite && (to - *value).abs() > NEAR * to.abs() { *value + step } else { to };
            }
            // A limit that is lowered holds at once.
            (g.max_force, g.max_torque) = (g.max_force.min(t.max_force), g.max_torque.min(t.max_torque));
            (g.law, g.passivity, g.ramp_time) = (t.law, t.passivity, t.ramp_time);
            (g.max_force_rate, g.max_torque_rate) = (t.max_force_rate, t.max_torque_rate);
            self.current = Some(g);
        }
        g
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_come_down_at_once_and_up_smoothly() {
        let mut ramp = GainRamp::default();
        let high = Gains { max_force: 10.0, max_torque: 1.0, ..Default::default() };
        let low = Gains { max_force: 2.0, max_torque: 0.1, ..high };
        ramp.step(&high, 1e-3);
        let now = ramp.step(&low, 1e-3);
        assert_eq!((now.max_force, now.max_torque), (2.0, 0.1));
        let now = ramp.step(&high, 1e-3);
        assert!(now.max_force > 2.0 && now.max_force < 2.2, "{}", now.max_force);
    }

    #[test]
    fn gains_arrive_exactly_and_without_a_jump() {
        let mut ramp = GainRamp::default();
        let from = Gains { proxy_speed: f64::INFINITY, ..Default::default() };
        assert_eq!(ramp.step(&from, 1e-3), from, "the first ones hold from the start");
        let to = Gains { stiffness: 3000.0, max_force: 1.0, proxy_speed: 1.0, ..from };
        let mut last = from;
        for _ in 0..1000 {
            let now = ramp.step(&to, 1e-3);
            assert!((now.stiffness - last.stiffness).abs() <= 2000.0 * 0.02);
            assert!(now.stiffness >= last.stiffness && now.max_force <= last.max_force);
            last = now;
        }
        assert_eq!(last, to);
    }
}
