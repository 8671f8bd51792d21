use super::config::{SpaceMouseConfig, SpaceMouseMode};
use spatial::{DQuat, DVec3, Pose, Twist};

/// Counts at full deflection; some devices exceed it a little.
const FULL_SCALE: f64 = 350.0;

/// The pose that a cap's deflections steer: base frame x right, y forward, z up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) pose: Pose,
    pub(super) twist: Twist,
    config: SpaceMouseConfig,
    /// Smoothed deflections, -1 to 1, base frame.
    shift: DVec3,
    turn: DVec3,
}

impl Motion {
    pub(super) fn new(config: SpaceMouseConfig) -> Self {
        Self { pose: Pose::IDENTITY, twist: Twist::ZERO, config, shift: DVec3::ZERO, turn: DVec3::ZERO }
    }

    /// Goes `dt` seconds on with the cap at raw `axes`.
    pub(super) fn advance(&mut self, axes: &[i16; 6], dt: f64) {
        let share = if self.config.smoothing > 0.0 { 1.0 - (-dt / self.config.smoothing).exp() } else { 1.0 };
        let [x, y, z, rx, ry, rz] = axes.map(|a| deflection(a, self.config.dead_band));
        // Raw axes point right, backward and down: a right-handed frame turned half about x.
        self.shift += (DVec3::new(x, -y, -z) - self.shift) * share;
        self.turn += (DVec3::new(rx, -ry, -rz) - self.turn) * share;
        let before = self.pose;
        self.pose = match self.config.mode {
            SpaceMouseMode::Rate => {
                let moved =
                    before.moved(self.shift * self.config.speed * dt, self.turn * self.config.angular_speed * dt);
                let reach = DVec3::splat(self.config.reach);
                Pose::new(moved.translation.clamp(-reach, reach), moved.rotation)
            }
            SpaceMouseMode::Position => {
                Pose::new(self.shift * self.config.reach, DQuat::from_scaled_axis(self.turn * self.config.angle))
            }
        };
        if dt > 0.0 {
            self.twist = Twist {
                linear: (self.pose.translation - before.translation) / dt,
                angular: before.rotation_to(&self.pose) / dt,
            };
        }
    }
}

/// -1 to 1; zero inside the dead band and continuous at its edge.
fn deflection(counts: i16, dead_band: f64) -> f64 {
    let x = (f64::from(counts) / FULL_SCALE).clamp(-1.0, 1.0);
    x.signum() * ((x.abs() - dead_band).max(0.0) / (1.0 - dead_band))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(config: SpaceMouseConfig, axes: [i16; 6], ticks: usize) -> Motion {
        let mut motion = Motion::new(config);
        for _ in 0..ticks {
            motion.advance(&axes, 1e-3);
        }
        motion
    }

    #[test]
    fn the_dead_band_is_dead_and_its_edge_is_smooth() {
        assert_eq!(deflection(14, 0.04), 0.0);
        assert_eq!(deflection(-14, 0.04), 0.0);
        assert!(deflection(15, 0.04) > 0.0 && deflection(15, 0.04) < 0.004);
        assert_eq!((deflection(350, 0.04), deflection(-400, 0.04), deflection(i16::MIN, 0.04)), (1.0, -1.0, -1.0));
    }

    #[test]
    fn rate_moves_forward_up_and_turns_with_the_hand() {
        let sharp = SpaceMouseConfig { smoothing: 0.0, ..Default::default() };
        // Forward is -y raw, up is -z raw.
        let motion = run(sharp, [0, -350, -350, 0, 0, 0], 100);
        assert!((motion.pose.translation - DVec3::new(0.0, 0.01, 0.01)).length() < 1e-12);
        assert!((motion.twist.linear - DVec3::new(0.0, 0.1, 0.1)).length() < 1e-9);
        // About the raw axis down by +: about up by -.
        let motion = run(sharp, [0, 0, 0, 0, 0, 350], 500);
        assert!((Pose::IDENTITY.rotation_to(&motion.pose) - DVec3::Z * -0.5).length() < 1e-9);
    }

    #[test]
    fn rate_stops_at_the_edge_of_the_workspace() {
        let motion = run(SpaceMouseConfig::default(), [350, 0, 0, 0, 0, 0], 5000);
        assert_eq!(motion.pose.translation, DVec3::X * 0.1);
        assert_eq!(motion.twist.linear, DVec3::ZERO);
    }

    #[test]
    fn position_springs_back() {
        let config = SpaceMouseConfig { mode: SpaceMouseMode::Position, ..Default::default() };
        let mut motion = run(config, [350, 0, 0, -350, 0, 0], 1000);
        assert!((motion.pose.translation - DVec3::X * 0.1).length() < 1e-9);
        assert!((Pose::IDENTITY.rotation_to(&motion.pose) - DVec3::X * -0.8).length() < 1e-9);
        for _ in 0..1000 {
            motion.advance(&[0; 6], 1e-3);
        }
        assert!(motion.pose.translation.length() < 1e-9);
    }

    #[test]
    fn smoothing_bounds_the_steps() {
        let config = SpaceMouseConfig { mode: SpaceMouseMode::Position, ..Default::default() };
        let mut motion = Motion::new(config);
        let mut last = 0.0;
        for _ in 0..200 {
            motion.advance(&[350, 0, 0, 0, 0, 0], 1e-3);
            assert!(motion.pose.translation.x - last < 0.1 * 0.05 + 1e-12);
            last = motion.pose.translation.x;
        }
    }
}
