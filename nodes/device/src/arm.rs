use crate::OperatorConfig;
use spatial::{Pose, Twist, Wrench};

/// A hand on an arm: a rigid mass on a damped spring to the intended pose, pushed by whatever wrench it feels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arm {
    pub(crate) pose: Pose,
    pub(crate) twist: Twist,
    config: OperatorConfig,
}

impl Arm {
    pub(crate) fn new(pose: Pose, config: OperatorConfig) -> Self {
        Self { pose, twist: Twist::ZERO, config }
    }

    /// `m a = K (x_d - x) + D (v_d - v) + f`, and the same for rotation: semi-implicit Euler, `h` seconds.
    pub(crate) fn step(&mut self, wanted: &Pose, wanted_twist: &Twist, felt: &Wrench, h: f64) {
        let c = &self.config;
        let force = (wanted.translation - self.pose.translation) * c.stiffness
            + (wanted_twist.linear - self.twist.linear) * c.damping
            + felt.force;
        let torque = self.pose.rotation_to(wanted) * c.rotation_stiffness
            + (wanted_twist.angular - self.twist.angular) * c.rotation_damping
            + felt.torque;
        self.twist.linear += force * (h / c.mass);
        self.twist.angular += torque * (h / c.inertia);
        self.pose = self.pose.moved(self.twist.linear * h, self.twist.angular * h);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DVec3;

    #[test]
    fn settles_where_springs_balance_the_wrench() {
        let config = OperatorConfig::default();
        let mut arm = Arm::new(Pose::IDENTITY, config);
        let felt = Wrench::new(DVec3::new(2.0, 0.0, -1.0), DVec3::new(0.0, 0.03, 0.0));
        for _ in 0..50_000 {
            arm.step(&Pose::IDENTITY, &Twist::ZERO, &felt, 1e-4);
        }
        assert!((arm.pose.translation - felt.force / config.stiffness).length() < 1e-9);
        let turn = Pose::IDENTITY.rotation_to(&arm.pose);
        assert!((turn - felt.torque / config.rotation_stiffness).length() < 1e-9);
        assert!(arm.twist.linear.length() < 1e-9);
    }

    #[test]
    fn rings_at_its_natural_frequency_and_loses_energy() {
        let mut arm = Arm::new(Pose::IDENTITY, OperatorConfig::default());
        let target = Pose::new(DVec3::X * 0.01, Pose::IDENTITY.rotation);
        let mut highest = (0.0, 0);
        for n in 0..10_000 {
            arm.step(&target, &Twist::ZERO, &Wrench::ZERO, 1e-4);
            if arm.pose.translation.x > highest.0 {
                highest = (arm.pose.translation.x, n);
            }
        }
        // m 1 kg, D 10 N.s/m, K 200 N/m: damping ratio 0.354, first peak at 0.2375 s, overshoot 30.5 %.
        assert!((highest.0 - 0.01305).abs() < 2e-5 && (highest.1 - 2375i32).abs() < 20, "{highest:?}");
    }
}
