//! The follower as a node: an example of a teleoperated robot at the end of a network.

use crate::follower::{Follower, Line, MotionLimits, Wall};
use crate::parameters::{Declared, ParameterServer};
use crate::servo_node::Due;
use crate::{Host, Listener, Outcome, Talker, qos};
use bag::msg::{Header, PoseStamped, WrenchStamped};
use r2r::ParameterValue as V;
use spatial::{DVec3, Pose, Stamp, Wrench};
use std::time::Duration;

const STEP: Duration = Duration::from_millis(2);

/// The follower's parameters.
#[must_use]
pub fn declared() -> Vec<Declared> {
    let number = |name: &str, value: f64, min: f64, max: f64, meaning: &str| {
        Declared::fixed(name, V::Double(value), meaning).within(min, max).live()
    };
    vec![
        number("limits.speed", 0.25, 1e-3, 10.0, "greatest speed [m/s]"),
        number("limits.acceleration", 2.0, 1e-2, 100.0, "greatest acceleration [m/s^2]"),
        number("limits.angular_speed", 1.5, 1e-2, 50.0, "greatest angular speed [rad/s]"),
        number("limits.angular_acceleration", 10.0, 0.1, 1000.0, "greatest angular acceleration [rad/s^2]"),
        number("network.delay", 0.0, 0.0, 2.0, "delay each way [s]"),
        number("network.loss", 0.0, 0.0, 0.99, "share of messages that is lost, each way"),
        number("wall.height", -10.0, -100.0, 100.0, "height of the wall z >= height that the robot meets [m]"),
        number("wall.stiffness", 2000.0, 0.0, 1e5, "stiffness of the wall [N/m]"),
        number("wall.damping", 20.0, 0.0, 1e3, "damping of the wall [N.s/m]"),
        number("return_gain", 0.2, 0.0, 1.0, "share of the measured wrench that is sent back"),
        number(
            "hand_damping",
            10.0,
            0.0,
            200.0,
            "damping of hand and device that can be counted on, for the check of stability [N.s/m]",
        ),
        Declared::fixed("publish_rate", V::Double(200.0), "rate of ~/pose and ~/wrench [Hz]").within(1.0, 500.0),
        Declared::fixed("frame_id", V::String("world".into()), "the world frame"),
        Declared::fixed("seed", V::Integer(1), "seed of the losses").within(0.0, 1e9),
    ]
}

/// Follows `target` (remap it to the servo's `~/proxy_pose`), publishes `~/pose` and the measured `~/wrench`.
pub struct FollowerNode<'h> {
    host: &'h mut Host,
    parameters: ParameterServer,
    target: Listener<PoseStamped>,
    pose: Talker<PoseStamped>,
    wrench: Talker<WrenchStamped>,
    there: Line<Pose>,
    back: Line<Wrench>,
    robot: Option<Follower>,
    goal: Pose,
    returned: Wrench,
    due: Due,
    frame_id: String,
}

impl<'h> FollowerNode<'h> {
    /// Declares parameters and topics.
    ///
    /// # Errors
    /// A parameter or topic is refused.
    pub fn start(host: &'h mut Host) -> Outcome<Self> {
        let parameters = ParameterServer::new(&mut host.node, declared())?;
        let seed = parameters.number("seed") as u64;
        Ok(Self {
            target: Listener::new(&mut host.node, "haptic_servo/proxy_pose", qos::sensor())?,
            pose: Talker::new(&mut host.node, "~/pose", qos::sensor())?,
            wrench: Talker::new(&mut host.node, "~/wrench", qos::sensor())?,
            there: Line::new(seed),
            back: Line::new(seed ^ 0x5eed),
            robot: None,
            goal: Pose::IDENTITY,
            returned: Wrench::ZERO,
            due: Due::every(1.0 / parameters.number("publish_rate")),
            frame_id: parameters.text("frame_id"),
            parameters,
            host,
        })
    }

    /// Runs until a signal.
    ///
    /// # Errors
    /// The middleware fails.
    pub fn run(mut self) -> Outcome<()> {
        self.check_stability();
        self.host.say_ready();
        let mut last = self.host.now();
        while !self.host.stopped() {
            self.host.spin_once(STEP);
            let now = self.host.now();
            let mut changed = false;
            self.parameters.serve(now, &mut |_| {
                changed = true;
                Ok(())
            })?;
            if changed {
                self.check_stability();
            }
            // A clock that stepped moves no robot.
            let dt = ((now.0 - last.0) as f64 * 1e-9).clamp(0.0, 0.02);
            last = now;
            self.step(now, dt)?;
        }
        // A lost message is sent no second time.
        for _ in 0..5 {
            let header = self.header(self.host.now());
            self.wrench.say(&WrenchStamped { header, wrench: Wrench::ZERO.into() })?;
            self.host.linger(Duration::from_millis(20));
        }
        Ok(())
    }

    fn step(&mut self, now: Stamp, dt: f64) -> Outcome<()> {
        let p = &self.parameters;
        let (delay, loss) = (p.number("network.delay"), p.number("network.loss"));
        while let Some(message) = self.target.take() {
            let pose: Pose = message.pose.into();
            if pose.is_valid() {
                self.there.send(pose, now, delay, loss);
            }
        }
        if let Some(goal) = self.there.receive(now) {
            self.goal = goal;
            // The robot stands where it is first told to be.
            self.robot.get_or_insert(Follower::new(goal));
        }
        let Some(robot) = &mut self.robot else { return Ok(()) };
        let limits = MotionLimits {
            speed: p.number("limits.speed"),
            acceleration: p.number("limits.acceleration"),
            angular_speed: p.number("limits.angular_speed"),
            angular_acceleration: p.number("limits.angular_acceleration"),
        };
        if dt > 0.0 {
            robot.step(&self.goal, &limits, dt);
        }
        let wall = Wall {
            normal: DVec3::Z,
            height: p.number("wall.height"),
            stiffness: p.number("wall.stiffness"),
            damping: p.number("wall.damping"),
        };
        let robot = *robot;
        if self.due.at(now) {
            let measured = wall.wrench(&robot.pose, robot.velocity()) * p.number("return_gain");
            self.back.send(measured, now, delay, loss);
            self.pose.say(&PoseStamped { header: self.header(now), pose: robot.pose.into() })?;
            if let Some(wrench) = self.back.receive(now) {
                self.returned = wrench;
                self.wrench.say(&WrenchStamped { header: self.header(now), wrench: wrench.into() })?;
            }
        }
        Ok(())
    }

    fn header(&self, at: Stamp) -> Header {
        Header { stamp: at.into(), frame_id: self.frame_id.clone() }
    }

    /// A spring of stiffness k felt through a delay T gives back k T of negative damping: the hand's own damping must
    /// cover it. Sufficient for a hand that moves slowly against 1/T; beyond it the servo's passivity controller limits.
    fn check_stability(&self) {
        let p = &self.parameters;
        let stiffness = p.number("return_gain") * p.number("wall.stiffness");
        let delay = 2.0 * p.number("network.delay") + 1.5 / p.number("publish_rate");
        let needed = stiffness * delay;
        if needed > p.number("hand_damping") {
            self.host.warn(&format!(
                "the wall through {delay:.3} s of delay needs {needed:.1} N.s/m of damping at the hand, there are {:.1}: \
                 lower return_gain below {:.3}",
                p.number("hand_damping"),
                p.number("hand_damping") / (p.number("wall.stiffness").max(1e-9) * delay)
            ));
        }
    }
}
