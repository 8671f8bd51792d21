//! The continuous side: a rigid mass on the springs of the grip, pushed by a wrench that is held between ticks.

use crate::rig::Rig;
use spatial::{DQuat, DVec3, Pose, Twist, Wrench};
use std::collections::VecDeque;

/// Steps of integration in a tick.
pub const FINE: usize = 50;

/// What may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// A device of three translations: the part keeps its orientation.
    Translation,
    /// All six.
    Whole,
}

/// Device and hand as one body, and what has gone over the handle.
pub struct Hand {
    rig: Rig,
    freedom: Freedom,
    start: Pose,
    pub pose: Pose,
    twist: Twist,
    /// Wrenches that are on their way to the motors, one a step.
    coming: VecDeque<Wrench>,
    /// Work that the device has done on the hand, J, and the most that it ever was.
    work: f64,
    pub most_work: f64,
}

impl Hand {
    pub fn new(rig: Rig, freedom: Freedom, start: Pose) -> Self {
        let late = (rig.device.delay / rig.period * FINE as f64).round() as usize;
        let coming = std::iter::repeat_n(Wrench::ZERO, late).collect();
        Self { rig, freedom, start, pose: start, twist: Twist::ZERO, coming, work: 0.0, most_work: 0.0 }
    }

    /// What the encoders say.
    pub fn measured(&self) -> Pose {
        let d = &self.rig.device;
        let turn = Pose::IDENTITY.rotation_to(&self.pose);
        let steps = |v: DVec3, step: f64| (v / step).round() * step;
        Pose::new(
            steps(self.pose.translation, d.resolution),
            DQuat::from_scaled_axis(steps(turn, d.angular_resolution)),
        )
    }

    /// One tick under the wrench `shown` at its beginning, while the hand pushes with `intended`.
    pub fn tick(&mut self, shown: &Wrench, intended: &Wrench) {
        let h = self.rig.period / FINE as f64;
        for _ in 0..FINE {
            self.coming.push_back(*shown);
            let felt = self.coming.pop_front().unwrap_or(Wrench::ZERO);
            self.step(&felt, intended, h);
        }
    }

    fn step(&mut self, felt: &Wrench, intended: &Wrench, h: f64) {
        let (g, d) = (&self.rig.grip, &self.rig.device);
        let force = felt.force + intended.force
            - (self.pose.translation - self.start.translation) * g.stiffness
            - self.twist.linear * (g.damping + d.damping);
        let acceleration = force / (g.mass + d.mass);
        let moved = (self.twist.linear + acceleration * (0.5 * h)) * h;
        self.twist.linear += acceleration * h;
        let mut turned = DVec3::ZERO;
        if self.freedom == Freedom::Whole {
            let torque = felt.torque + intended.torque
                - self.start.rotation_to(&self.pose) * g.rotation_stiffness
                - self.twist.angular * (g.rotation_damping + d.rotation_damping);
            let acceleration = torque / (g.inertia + d.inertia);
            turned = (self.twist.angular + acceleration * (0.5 * h)) * h;
            self.twist.angular += acceleration * h;
        }
        self.pose = self.pose.moved(moved, turned);
        self.work += felt.force.dot(moved) + felt.torque.dot(turned);
        self.most_work = self.most_work.max(self.work);
    }
}
