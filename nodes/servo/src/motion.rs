use device::Sample;
use haptics::{Displacement, low_pass_share};
use spatial::{Pose, Stamp, Twist};

/// How the hand moves: what it did since the last tick, and how fast it goes.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    cutoff: f64,
    last: Option<(Pose, Stamp)>,
    /// Rate between the last two samples, held until the next: a device slower than the servo does not stop in between.
    rate: Twist,
    filtered: Twist,
}

impl Motion {
    /// Velocity is low-passed at `cutoff` Hz unless the device measures it.
    #[must_use]
    pub fn new(cutoff: f64) -> Self {
        Self { cutoff, last: None, rate: Twist::ZERO, filtered: Twist::ZERO }
    }

    /// Takes the newest good sample, `fresh` if it is new in this tick of `dt` seconds, and gives what the hand moved
    /// since the last tick.
    pub fn step(&mut self, sample: &Sample, fresh: bool, dt: f64) -> Displacement {
        let mut moved = Displacement::default();
        if fresh {
            let now = (sample.pose, sample.stamp);
            let (pose, stamp) = self.last.replace(now).unwrap_or(now);
            moved.linear = sample.pose.translation - pose.translation;
            moved.angular = pose.rotation_to(&sample.pose);
            // Stamps of one device; never shorter than half a tick, whatever they say.
            let per_second = 1.0 / (sample.stamp.0.saturating_sub(stamp.0) as f64 * 1e-9).max(0.5 * dt);
            self.rate = Twist { linear: moved.linear * per_second, angular: moved.angular * per_second };
        }
        let share = low_pass_share(self.cutoff, dt);
        self.filtered.linear += (self.rate.linear - self.filtered.linear) * share;
        self.filtered.angular += (self.rate.angular - self.filtered.angular) * share;
        if sample.has_twist {
            self.filtered = sample.twist;
        }
        moved
    }

    /// Velocity of the hand, m/s and rad/s.
    #[must_use]
    pub fn twist(&self) -> Twist {
        self.filtered
    }

    /// What the hand moves in a tick of `dt` seconds at the rate of its last two samples.
    #[must_use]
    pub fn in_a_tick(&self, dt: f64) -> Displacement {
        Displacement { linear: self.rate.linear * dt, angular: self.rate.angular * dt }
    }

    /// The hand was elsewhere before: that was no motion.
    pub fn restart(&mut self) {
        (self.rate, self.filtered) = (Twist::ZERO, Twist::ZERO);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DVec3;

    #[test]
    fn a_slow_device_moves_evenly_and_no_motion_is_lost() {
        let mut motion = Motion::new(150.0);
        let mut sum = DVec3::ZERO;
        let mut sample = Sample::default();
        for i in 0..1000i64 {
            // 250 Hz under 1 kHz, 0.2 m/s.
            let fresh = i % 4 == 0;
            if fresh {
                sample.stamp = Stamp(i * 1_000_000);
                sample.pose.translation = DVec3::X * (0.2e-3 * i as f64);
            }
            sum += motion.step(&sample, fresh, 1e-3).linear;
        }
        assert!((sum.x - 0.2e-3 * 996.0).abs() < 1e-12);
        assert!((motion.twist().linear.x - 0.2).abs() < 1e-9);
        assert!((motion.in_a_tick(1e-3).linear.x - 0.2e-3).abs() < 1e-12);
    }
}
