use spatial::{DVec3, Pose, Twist};

/// A minimum-jerk motion from one pose to another (Flash and Hogan 1985): what a practised hand does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    from: Pose,
    shift: DVec3,
    turn: DVec3,
    duration: f64,
}

impl Stroke {
    /// A motion that takes `duration` seconds.
    pub(crate) fn new(from: Pose, to: &Pose, duration: f64) -> Self {
        Self { from, shift: to.translation - from.translation, turn: from.rotation_to(to), duration }
    }

    /// How long it takes, s.
    pub(crate) fn duration(&self) -> f64 {
        self.duration
    }

    /// Pose and velocity `t` seconds after the start.
    pub(crate) fn at(&self, t: f64) -> (Pose, Twist) {
        let tau = (t / self.duration).clamp(0.0, 1.0);
        let s = tau * tau * tau * (10.0 + tau * (6.0 * tau - 15.0));
        let speed = 30.0 * tau * tau * (1.0 - tau) * (1.0 - tau) / self.duration;
        let twist = Twist { linear: self.shift * speed, angular: self.turn * speed };
        (self.from.moved(self.shift * s, self.turn * s), twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_and_ends_at_rest_and_its_velocity_is_the_slope() {
        let to = Pose::from_xyz_rpy(DVec3::new(0.1, 0.0, -0.2), DVec3::new(0.0, 0.3, 1.0));
        let stroke = Stroke::new(Pose::IDENTITY, &to, 2.0);
        assert_eq!(stroke.at(0.0).1, Twist::ZERO);
        assert!(stroke.at(2.0).0.rotation_to(&to).length() < 1e-12 && stroke.at(5.0).1 == Twist::ZERO);
        let (a, b) = (stroke.at(0.7 - 1e-5).0, stroke.at(0.7 + 1e-5).0);
        let twist = stroke.at(0.7).1;
        assert!(((b.translation - a.translation) / 2e-5 - twist.linear).length() < 1e-8);
        assert!((a.rotation_to(&b) / 2e-5 - twist.angular).length() < 1e-8);
    }
}
