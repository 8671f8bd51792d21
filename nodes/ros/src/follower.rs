//! A teleoperated robot in small: it follows a pose with limited speed and acceleration and feels one wall.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use spatial::{DVec3, Pose, Stamp, Wrench};
use std::collections::VecDeque;

/// How fast the robot may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionLimits {
    /// m/s.
    pub speed: f64,
    /// m/s^2.
    pub acceleration: f64,
    /// rad/s.
    pub angular_speed: f64,
    /// rad/s^2.
    pub angular_acceleration: f64,
}

/// The robot's motion: a trapezoid of speed towards a target that moves.
#[derive(Clone, Copy, Debug)]
pub struct Follower {
    /// Where the robot is, W.
    pub pose: Pose,
    linear: DVec3,
    angular: DVec3,
}

impl Follower {
    /// At rest at `pose`.
    #[must_use]
    pub const fn new(pose: Pose) -> Self {
        Self { pose, linear: DVec3::ZERO, angular: DVec3::ZERO }
    }

    /// Velocity of the robot's frame, m/s, axes of W.
    #[must_use]
    pub const fn velocity(&self) -> DVec3 {
        self.linear
    }

    /// One step of `dt` seconds towards `target`.
    pub fn step(&mut self, target: &Pose, limits: &MotionLimits, dt: f64) {
        let ahead = target.translation - self.pose.translation;
        self.linear = approach(ahead, self.linear, limits.speed, limits.acceleration, dt);
        let turn = self.pose.rotation_to(target);
        self.angular = approach(turn, self.angular, limits.angular_speed, limits.angular_acceleration, dt);
        self.pose = self.pose.moved(self.linear * dt, self.angular * dt);
    }
}

/// The velocity of the next step: towards what lies `ahead`, slow enough to stop there, changed by at most
/// `acceleration * dt`.
fn approach(ahead: DVec3, velocity: DVec3, speed: f64, acceleration: f64, dt: f64) -> DVec3 {
    let distance = ahead.length();
    // In steps of dt the speed from which one still stops at the target is that of the parabola half a step earlier;
    // distance / dt ends the approach; what it can run over is below the resolution of a step, acceleration * dt^2.
    let half = 0.5 * acceleration * dt;
    let stopping = (half * half + 2.0 * acceleration * distance).sqrt() - half;
    let wanted = if distance > 0.0 { ahead * (speed.min(stopping).min(distance / dt) / distance) } else { DVec3::ZERO };
    velocity + (wanted - velocity).clamp_length_max(acceleration * dt)
}

/// A wall `normal . p >= height` that the robot presses against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Unit normal out of the wall, W.
    pub normal: DVec3,
    /// Distance of its surface from the origin along the normal, metres.
    pub height: f64,
    /// N/m.
    pub stiffness: f64,
    /// N.s/m.
    pub damping: f64,
}

impl Wall {
    /// What a sensor between robot and tool measures: the wrench of the wall on the tool. A wall only pushes.
    #[must_use]
    pub fn wrench(&self, pose: &Pose, velocity: DVec3) -> Wrench {
        let depth = self.height - self.normal.dot(pose.translation);
        let force = self.stiffness * depth - self.damping * self.normal.dot(velocity);
        if depth > 0.0 && force > 0.0 { Wrench::new(self.normal * force, DVec3::ZERO) } else { Wrench::ZERO }
    }
}

/// A line that delays what goes through it and loses some: the network between hand and robot.
#[derive(Debug)]
pub struct Line<T> {
    waiting: VecDeque<(Stamp, T)>,
    random: Pcg64Mcg,
}

impl<T> Line<T> {
    /// An empty line; the same seed loses the same messages.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { waiting: VecDeque::new(), random: Pcg64Mcg::seed_from_u64(seed) }
    }

    /// Puts a message in: lost with probability `loss`, else delivered `delay` seconds after `now`.
    pub fn send(&mut self, message: T, now: Stamp, delay: f64, loss: f64) {
        if self.random.random::<f64>() >= loss {
            self.waiting.push_back((Stamp(now.0 + (delay * 1e9) as i64), message));
        }
    }

    /// The newest message that is due.
    pub fn receive(&mut self, now: Stamp) -> Option<T> {
        let mut newest = None;
        while self.waiting.front().is_some_and(|(due, _)| *due <= now) {
            newest = self.waiting.pop_front().map(|(_, m)| m);
        }
        newest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: MotionLimits =
        MotionLimits { speed: 0.25, acceleration: 2.0, angular_speed: 1.0, angular_acceleration: 10.0 };

    #[test]
    fn it_arrives_without_overshoot_and_within_its_limits() {
        let target = Pose::from_xyz_rpy(DVec3::new(0.1, -0.05, 0.02), DVec3::new(0.3, 0.0, -0.5));
        let mut robot = Follower::new(Pose::IDENTITY);
        let (mut last, dt) = (DVec3::ZERO, 1e-3);
        for _ in 0..3000 {
            robot.step(&target, &LIMITS, dt);
            assert!(robot.velocity().length() <= LIMITS.speed * (1.0 + 1e-12));
            assert!((robot.velocity() - last).length() <= LIMITS.acceleration * dt * (1.0 + 1e-9));
            let over = robot.pose.translation.x - target.translation.x;
            assert!(over <= LIMITS.acceleration * dt * dt, "overshoot by {over} m");
            last = robot.velocity();
        }
        assert!((robot.pose.translation - target.translation).length() < 1e-6);
        assert!(robot.pose.rotation_to(&target).length() < 1e-6);
    }

    #[test]
    fn a_wall_pushes_and_never_pulls() {
        let wall = Wall { normal: DVec3::Z, height: 0.0, stiffness: 1000.0, damping: 10.0 };
        let at = |z: f64| Pose::new(DVec3::new(0.0, 0.0, z), spatial::DQuat::IDENTITY);
        assert_eq!(wall.wrench(&at(0.001), DVec3::ZERO), Wrench::ZERO);
        assert!((wall.wrench(&at(-0.001), DVec3::ZERO).force.z - 1.0).abs() < 1e-12);
        assert_eq!(wall.wrench(&at(-0.001), DVec3::Z), Wrench::ZERO);
    }

    #[test]
    fn the_line_delays_and_loses_the_share_it_was_told() {
        let mut line = Line::new(1);
        for i in 0..1000i64 {
            line.send(i, Stamp(i * 1_000_000), 0.05, 0.3);
        }
        assert_eq!(line.receive(Stamp(49_000_000)), None);
        let left = 1000 - line.waiting.len();
        assert!((250..350).contains(&left), "{left} lost");
        let newest = line.receive(Stamp(100_000_000)).unwrap();
        assert!((40..=50).contains(&newest), "{newest}");
    }
}
