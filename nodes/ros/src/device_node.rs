//! The device alone as a node, so that device and servo can live on two machines.

use crate::parameters::{Declared, ParameterServer};
use crate::servo_node::{DeviceWatch, Due, apply, declared as servo_parameters, open_local, scene_file};
use crate::{Failure, Host, Inbox, Listener, Outcome, Talker, qos};
use bag::msg::{Header, Joy, PoseStamped, TwistStamped, WrenchStamped};
use device::{HapticDevice, Sample};
use r2r::diagnostic_msgs::msg::{DiagnosticArray, DiagnosticStatus, KeyValue};
use r2r::std_srvs::srv::SetBool;
use r2r::{ParameterValue as V, Publisher, QosProfile, ServiceRequest};
use realtime::ThreadSetup;
use scene::Scene;
use servo::config::Config;
use spatial::{Stamp, Twist, Wrench};
use std::time::{Duration, Instant};

/// How often the device is read and the wrench is written.
const PERIOD: Duration = Duration::from_millis(1);

/// The node's parameters: the servo's for its device, and what concerns this node alone.
#[must_use]
pub fn declared() -> Vec<Declared> {
    let mut all: Vec<Declared> = servo_parameters()
        .into_iter()
        .filter(|d| d.name.starts_with("device.") || ["frame_id", "scene", "enabled"].contains(&d.name.as_str()))
        .collect();
    // What the servo asks of a device behind topics is none of the device's business.
    all.retain(|d| !["device.trust_stamps", "device.timeout"].contains(&d.name.as_str()));
    for driver in all.iter_mut().filter(|d| d.name == "device.driver") {
        driver.choices.retain(|c| c != "topic");
        driver.description =
            "Where the hand's pose comes from: simulated operator, file of poses, or SpaceMouse.".into();
    }
    all.push(
        Declared::fixed("publish_rate", V::Double(1000.0), "rate of ~/pose, ~/twist and ~/wrench [Hz]")
            .within(1.0, 1000.0),
    );
    all.push(
        Declared::fixed(
            "command_timeout",
            V::Double(0.02),
            "silence of ~/command/wrench after which force is zero [s]",
        )
        .within(0.002, 1.0)
        .live(),
    );
    all.push(
        Declared::fixed("realtime.priority", V::Integer(70), "SCHED_FIFO priority of the loop; 0 for none")
            .within(0.0, 99.0),
    );
    all
}

/// The wrench that the device may show now: zero unless enabled and commanded a moment ago.
#[derive(Clone, Copy, Debug, Default)]
struct Commanded {
    wrench: Wrench,
    /// By the monotonic clock: whatever becomes of the wall clock, a command that is not renewed runs out.
    since: Option<Instant>,
}

impl Commanded {
    fn hear(&mut self, wrench: Wrench, now: Instant) {
        // A wrench that is no number is no command: the last good one runs out.
        if wrench.is_finite() {
            *self = Self { wrench, since: Some(now) };
        }
    }

    fn at(&self, now: Instant, enabled: bool, timeout: f64) -> Wrench {
        let fresh = self.since.is_some_and(|t| (now - t).as_secs_f64() <= timeout);
        if enabled && fresh { self.wrench } else { Wrench::ZERO }
    }
}

/// The device as a node.
pub struct DeviceNode<'h> {
    host: &'h mut Host,
    parameters: ParameterServer,
    device: Box<dyn HapticDevice>,
    watch: DeviceWatch,
    frame_id: String,
    pose: Talker<PoseStamped>,
    twist: Talker<TwistStamped>,
    joy: Talker<Joy>,
    shown: Talker<WrenchStamped>,
    diagnostics: Publisher<DiagnosticArray>,
    command: Listener<WrenchStamped>,
    enable: Inbox<ServiceRequest<SetBool::Service>>,
    enabled: bool,
    commanded: Commanded,
    last: Sample,
    pose_due: Due,
    shown_due: Due,
    joy_due: Due,
    report_due: Due,
}

impl<'h> DeviceNode<'h> {
    /// Opens the device and offers the topics.
    ///
    /// # Errors
    /// A parameter is refused, or the device is not there.
    pub fn start(host: &'h mut Host) -> Outcome<Self> {
        let parameters = ParameterServer::new(&mut host.node, declared())?;
        let mut config = Config::default();
        apply(&mut config, parameters.values()).map_err(Failure::new)?;
        let scene = Scene::load(&scene_file(&config.scene)?).map_err(|e| Failure::new(e.to_string()))?;
        let (device, watch) = open_local(&config, &scene)?;
        let node = &mut host.node;
        Ok(Self {
            pose: Talker::new(node, "~/pose", qos::sensor())?,
            twist: Talker::new(node, "~/twist", qos::sensor())?,
            joy: Talker::new(node, "~/joy", QosProfile::default())?,
            shown: Talker::new(node, "~/wrench", qos::sensor())?,
            diagnostics: node.create_publisher("/diagnostics", QosProfile::default())?,
            command: Listener::new(node, "~/command/wrench", qos::sensor())?,
            enable: Inbox::new(node.create_service::<SetBool::Service>("~/enable", QosProfile::services_default())?),
            enabled: parameters.switch("enabled"),
            pose_due: Due::every(1.0 / parameters.number("publish_rate")),
            shown_due: Due::every(1.0 / parameters.number("publish_rate")),
            joy_due: Due::every(0.02),
            report_due: Due::every(1.0),
            commanded: Commanded::default(),
            last: Sample::default(),
            frame_id: config.frame_id,
            device,
            watch,
            parameters,
            host,
        })
    }

    /// Runs until a signal, then lets the force go.
    ///
    /// # Errors
    /// The middleware fails; the force is gone in any case.
    pub fn run(mut self) -> Outcome<()> {
        let priority = self.parameters.number("realtime.priority") as u8;
        let grants = ThreadSetup { priority, cpu: -1, lock_memory: false }.apply();
        if !grants.all_granted() {
            self.host.warn(&format!("real time: {grants}"));
        }
        self.host.say_ready();
        let outcome = self.turns();
        self.device.write(&Wrench::ZERO);
        // The force is gone whether or not anybody can be told; a lost message is sent no second time.
        let told = (0..5).try_for_each(|_| {
            let header = Header { stamp: self.host.now().into(), frame_id: self.frame_id.clone() };
            let told = self.shown.say(&WrenchStamped { header, wrench: Wrench::ZERO.into() });
            self.host.linger(Duration::from_millis(20));
            told
        });
        outcome.and(told)
    }

    fn turns(&mut self) -> Outcome<()> {
        let mut next = Instant::now();
        while !self.host.stopped() {
            // Messages that come meanwhile end the wait early: the rest of it follows.
            loop {
                self.host.spin_once(next.saturating_duration_since(Instant::now()));
                if Instant::now() >= next {
                    break;
                }
            }
            next = (next + PERIOD).max(Instant::now());
            let now = self.host.now();
            self.serve(now)?;
            let wrench = self.commanded.at(Instant::now(), self.enabled, self.parameters.number("command_timeout"));
            self.device.write(&wrench);
            self.tell_shown(&wrench)?;
            let sample = self.device.read(now);
            self.publish(now, &sample)?;
        }
        Ok(())
    }

    /// What the hand feels, stamped when the device was told: what came on the command topic and was not too old.
    fn tell_shown(&mut self, wrench: &Wrench) -> Outcome<()> {
        let at = self.host.now();
        if !self.shown_due.at(at) {
            return Ok(());
        }
        let header = Header { stamp: at.into(), frame_id: self.frame_id.clone() };
        self.shown.say(&WrenchStamped { header, wrench: (*wrench).into() })
    }

    fn serve(&mut self, now: Stamp) -> Outcome<()> {
        if let Some(message) = self.command.take_newest() {
            let wrench: Wrench = message.wrench.into();
            // Not a number stays so, for `hear` to refuse.
            let shown = if wrench.is_finite() { self.device.spec().shown(&wrench) } else { wrench };
            self.commanded.hear(shown, Instant::now());
        }
        while let Some(request) = self.enable.take() {
            self.enabled = request.message.data;
            let message = if self.enabled { "force as commanded" } else { "force is off" };
            request.respond(SetBool::Response { success: true, message: message.into() })?;
        }
        self.parameters.serve(now, &mut |_| Ok(()))
    }

    fn publish(&mut self, now: Stamp, sample: &Sample) -> Outcome<()> {
        let header = |at: Stamp| Header { stamp: at.into(), frame_id: self.frame_id.clone() };
        // A device that is gone or frozen is silent here, so that the servo's own age check speaks.
        let fresh = sample.connected && sample.sequence != self.last.sequence;
        if fresh && self.pose_due.at(now) {
            self.pose.say(&PoseStamped { header: header(sample.stamp), pose: sample.pose.into() })?;
            let twist = if sample.has_twist { sample.twist } else { velocity(&self.last, sample) };
            self.twist.say(&TwistStamped { header: header(sample.stamp), twist: twist.into() })?;
            self.last = *sample;
        }
        if sample.connected && (sample.buttons != self.last.buttons || self.joy_due.at(now)) {
            let buttons = (0..32).map(|i| (sample.buttons >> i & 1) as i32).collect();
            self.joy.say(&Joy { header: header(sample.stamp), axes: Vec::new(), buttons })?;
            self.last.buttons = sample.buttons;
        }
        if self.report_due.at(now) {
            self.watch.tell(self.host);
            self.diagnostics.publish(&self.report(now, sample))?;
        }
        Ok(())
    }

    fn report(&self, now: Stamp, sample: &Sample) -> DiagnosticArray {
        let spec = self.device.spec();
        let value = |key: &str, value: String| KeyValue { key: key.to_owned(), value };
        let (level, message) = if sample.connected { (0, "good") } else { (2, "not connected") };
        let status = DiagnosticStatus {
            level,
            name: format!("{}: device", self.host.name().trim_start_matches('/')),
            message: message.into(),
            hardware_id: spec.name.clone(),
            values: vec![
                value("samples", sample.sequence.to_string()),
                value("force enabled", self.enabled.to_string()),
                value("greatest force (N)", spec.max_force.to_string()),
                value("greatest torque (N.m)", spec.max_torque.to_string()),
                value("commands that could not be read", self.command.refused().to_string()),
            ],
        };
        DiagnosticArray { header: crate::convert::header(now, ""), status: vec![status] }
    }
}

/// Velocity between two samples; zero for the first one.
fn velocity(last: &Sample, now: &Sample) -> Twist {
    let dt = (now.stamp.0 - last.stamp.0) as f64 * 1e-9;
    if last.sequence == 0 || dt <= 0.0 {
        return Twist::ZERO;
    }
    Twist {
        linear: (now.pose.translation - last.pose.translation) / dt,
        angular: last.pose.rotation_to(&now.pose) / dt,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DVec3;

    #[test]
    fn force_needs_a_command_that_is_enabled_and_fresh() {
        let push = Wrench::new(DVec3::X, DVec3::ZERO);
        let start = Instant::now();
        let ms = |t: u64| start + Duration::from_millis(t);
        let mut c = Commanded::default();
        assert_eq!(c.at(ms(0), true, 0.02), Wrench::ZERO);
        c.hear(push, ms(1000));
        assert_eq!(c.at(ms(1010), true, 0.02), push);
        assert_eq!(c.at(ms(1010), false, 0.02), Wrench::ZERO);
        assert_eq!(c.at(ms(1021), true, 0.02), Wrench::ZERO);
        c.hear(Wrench::new(DVec3::NAN, DVec3::ZERO), ms(1030));
        assert_eq!(c.at(ms(1030), true, 0.02), Wrench::ZERO);
    }

    #[test]
    fn velocity_is_that_of_the_motion_between_samples() {
        let a = Sample { sequence: 1, stamp: Stamp(0), ..Sample::default() };
        let b = Sample {
            sequence: 2,
            stamp: Stamp(10_000_000),
            pose: a.pose.moved(DVec3::new(0.001, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.02)),
            ..a
        };
        let v = velocity(&a, &b);
        assert!((v.linear.x - 0.1).abs() < 1e-12 && (v.angular.z - 2.0).abs() < 1e-9);
        assert_eq!(velocity(&Sample::default(), &b), Twist::ZERO);
    }
}
