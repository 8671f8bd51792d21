use super::contact_events::ContactEvents;
use super::drivers;
use super::setup::{apply, declared, scene_file};
use super::{CSpaceView, DeviceLimits, DeviceWatch, Due, Frames, ServoTopics, TopicLink};
use crate::convert::{ServoReport, scene_description, sha256};
use crate::parameters::ParameterServer;
use crate::{Failure, Host, Inbox, Listener, Outcome, Talker, qos};
use bag::msg::{ContactState, Header, LocalCSpace, SceneDescription, ServoConfiguration, ServoHealth, WrenchStamped};
use device::HapticDevice;
use r2r::diagnostic_msgs::msg::DiagnosticArray;
use r2r::std_srvs::srv::{SetBool, Trigger};
use r2r::{Publisher, QosProfile, ServiceRequest};
use realtime::{Grant, ThreadSetup};
use scene::Scene;
use servo::config::Config;
use servo::{AlignedDevice, Commands, Health, LoopConfig, Servo, Tick, TickRecord};
use spatial::{Stamp, Wrench};
use std::time::{Duration, Instant};

/// A wrench from the robot older than this is let go.
const REMOTE_TIMEOUT: Duration = Duration::from_millis(100);
/// How often C-space is told to those who listen, s.
const CSPACE_PERIOD: f64 = 1.0 / 60.0;
/// How long a turn waits for requests: well below a batch of ticks.
const TURN: Duration = Duration::from_millis(2);

/// The servo as a node.
pub struct ServoNode<'h> {
    host: &'h mut Host,
    parameters: ParameterServer,
    config: Config,
    commands: Commands,
    servo: Servo,
    link: Option<TopicLink>,
    watch: DeviceWatch,
    limits: DeviceLimits,
    topics: ServoTopics,
    events: ContactEvents,
    contacts: Talker<ContactState>,
    cspace: Talker<LocalCSpace>,
    cspace_view: CSpaceView,
    cspace_due: Due,
    configuration: Talker<ServoConfiguration>,
    scene_name: String,
    /// Kept: a late joiner is given its message by the middleware as long as the publisher lives.
    _scene: Talker<SceneDescription>,
    health: Talker<ServoHealth>,
    diagnostics: Publisher<DiagnosticArray>,
    enable: Inbox<ServiceRequest<SetBool::Service>>,
    reset: Inbox<ServiceRequest<Trigger::Service>>,
    remote: Listener<WrenchStamped>,
    remote_since: Option<Instant>,
    last: TickRecord,
    since: Health,
    report_due: Due,
    ongoing_due: Due,
}

impl<'h> ServoNode<'h> {
    /// Reads the parameters, builds the scene, opens the device and starts the loop.
    ///
    /// # Errors
    /// Whatever cannot be had: a parameter, the scene, the device, a thread.
    pub fn start(host: &'h mut Host) -> Outcome<Self> {
        let mut parameters = ParameterServer::new(&mut host.node, declared())?;
        let mut config = Config::default();
        apply(&mut config, parameters.values()).map_err(Failure::new)?;
        let file = scene_file(&config.scene)?;
        let scene = Scene::load(&file).map_err(|e| Failure::new(e.to_string()))?;
        let frames = Frames { world: config.frame_id.clone(), part: config.child_frame_id.clone() };
        let node = &mut host.node;
        let (rate, tick_rate) = (config.publish_rate, config.realtime.rate);
        let topics = ServoTopics::new(node, frames, &scene.world, rate, tick_rate, parameters.switch("publish_tf"))?;
        let contacts = Talker::new(node, "~/contacts", qos::events())?;
        let cspace = Talker::new(node, "~/cspace", QosProfile::default())?;
        let scene_talker = Talker::new(node, "~/scene", qos::latched(1))?;
        let configuration = Talker::new(node, "~/configuration", qos::latched(1))?;
        let health = Talker::new(node, "~/health", QosProfile::default())?;
        let diagnostics = node.create_publisher("/diagnostics", QosProfile::default())?;
        let enable = Inbox::new(node.create_service::<SetBool::Service>("~/enable", QosProfile::services_default())?);
        let reset = Inbox::new(node.create_service::<Trigger::Service>("~/reset", QosProfile::services_default())?);
        let remote = Listener::new(node, "~/remote_wrench", qos::sensor())?;
        let trust_stamps = parameters.switch("device.trust_stamps");
        let drivers::Opened { device, link, watch } = drivers::open(node, &config, &scene, trust_stamps)?;
        let findings = servo::check_stability(&config, &scene)
            .map_err(|f| Failure::new(format!("stability.check refuses to start: {f}")))?;
        findings.iter().for_each(|f| host.warn(&f.to_string()));
        let limits = if link.is_some() { DeviceLimits::unknown() } else { DeviceLimits::of(device.spec()) };
        limits.finding(&config.gains).iter().for_each(|f| host.warn(f));
        let gains = limits.hold(config.gains);
        let commands = Commands { enabled: parameters.switch("enabled"), gains, ..Commands::default() };
        let servo = spawn_loop(device, &scene, &config, commands)?;
        scene_talker.say(&scene_description(&scene, host.now(), &config.frame_id))?;
        parameters.serve(host.now(), &mut |_| Ok(()))?;
        let node = Self {
            events: ContactEvents::new(&config, &scene.world),
            cspace,
            cspace_view: CSpaceView::new(&scene.world, &config.frame_id),
            cspace_due: Due::every(CSPACE_PERIOD),
            report_due: Due::every(1.0),
            ongoing_due: Due::every(0.5),
            last: TickRecord::default(),
            since: Health::GOOD,
            remote_since: None,
            scene_name: scene.name.clone(),
            _scene: scene_talker,
            host,
            parameters,
            config,
            commands,
            servo,
            link,
            watch,
            limits,
            topics,
            contacts,
            configuration,
            health,
            diagnostics,
            enable,
            reset,
            remote,
        };
        node.say_configuration()?;
        Ok(node)
    }

    /// Runs until a signal, then lets the force go, joins the loop and sends what is left.
    ///
    /// # Errors
    /// The loop ended by itself, or the middleware failed; the force is gone in any case.
    pub fn run(mut self) -> Outcome<()> {
        let grants = self.servo.handle.grants().to_string();
        if !self.servo.handle.grants().all_granted() {
            self.host.warn(&format!("real time: {grants}"));
        }
        self.host.say_ready();
        let outcome = self.turns(&grants);
        self.servo.handle.stop();
        let ended = self.finish();
        outcome.and(ended)
    }

    fn turns(&mut self, grants: &str) -> Outcome<()> {
        while !self.host.stopped() {
            if !self.servo.handle.is_running() {
                return Ok(()); // `finish` joins the thread and says why it ended.
            }
            self.host.spin_once(TURN);
            let now = self.host.now();
            self.serve(now)?;
            if let Some(link) = &mut self.link
                && let Some(warning) = link.turn(now)?
            {
                self.host.warn(&warning);
            }
            self.publish_ticks()?;
            if self.report_due.at(now) {
                self.report(now, grants)?;
            }
        }
        Ok(())
    }

    /// Answers requests and hands the newest commands to the loop.
    fn serve(&mut self, now: Stamp) -> Outcome<()> {
        let before = self.commands;
        while let Some(request) = self.enable.take() {
            self.commands.enabled = request.message.data;
            let message = if request.message.data { "force ramps up" } else { "force is off" };
            // Told after it is so: the cell is read by the next tick.
            self.servo.commands.write(self.commands);
            request.respond(SetBool::Response { success: true, message: message.into() })?;
        }
        while let Some(request) = self.reset.take() {
            self.commands.reset_count = self.commands.reset_count.wrapping_add(1);
            self.servo.commands.write(self.commands);
            request.respond(Trigger::Response { success: true, message: "contact is sought anew".into() })?;
        }
        let mut wanted = self.config.clone();
        self.parameters.serve(now, &mut |new| apply(&mut wanted, new))?;
        if wanted != self.config {
            let most = |c: &Config| (c.gains.max_force, c.gains.max_torque);
            if most(&wanted) != most(&self.config) {
                self.limits.finding(&wanted.gains).iter().for_each(|f| self.host.warn(f));
            }
            self.config = wanted;
            self.commands.gains = self.limits.hold(self.config.gains);
            self.say_configuration()?;
        }
        self.hear_robot();
        if self.commands != before {
            self.servo.commands.write(self.commands);
        }
        Ok(())
    }

    /// The wrench measured at a robot that follows; silence is no force, by the monotonic clock.
    fn hear_robot(&mut self) {
        if let Some(message) = self.remote.take_newest() {
            let wrench: Wrench = message.wrench.into();
            if wrench.is_finite() {
                self.commands.remote = wrench;
                self.remote_since = Some(Instant::now());
            }
        }
        if self.remote_since.is_some_and(|t| t.elapsed() > REMOTE_TIMEOUT) {
            self.commands.remote = Wrench::ZERO;
            self.remote_since = None;
        }
    }

    fn publish_ticks(&mut self) -> Outcome<()> {
        while let Some(tick) = self.servo.records.pop() {
            self.topics.tick(&tick, self.servo.records.dropped())?;
            for event in self.events.add(&tick) {
                self.contacts.say(&event)?;
            }
            if self.ongoing_due.at(tick.input.stamp)
                && let Some(state) = self.events.ongoing(&tick)
            {
                self.contacts.say(&state)?;
            }
            // Of the newest tick alone: where C-space takes long to draw, it is drawn less often and no tick waits for it.
            let newest = self.servo.records.is_empty() && tick.hip.is_valid();
            if newest && self.cspace_due.at(tick.input.stamp) && self.cspace.listeners() > 0 {
                self.cspace.say(&self.cspace_view.at(&tick))?;
            }
            self.since.set(tick.health);
            self.last = tick;
        }
        // Nobody draws in this process: the pictures' ring must not look full.
        while self.servo.pictures.pop().is_some() {}
        Ok(())
    }

    fn report(&mut self, now: Stamp, grants: &str) -> Outcome<()> {
        self.watch.tell(self.host);
        let report = ServoReport {
            status: self.servo.status.read(),
            last: &self.last,
            since: self.since,
            grants,
            realtime: matches!(self.servo.handle.grants().scheduling, Grant::Granted),
            period: self.config.realtime.period(),
            law: &self.parameters.text("law"),
        };
        self.health.say(&report.health_message(now, &self.config.frame_id))?;
        let hardware = self.parameters.text("device.driver");
        self.diagnostics.publish(&report.diagnostics(now, self.host.name(), &hardware))?;
        self.since = Health::GOOD;
        Ok(())
    }

    fn say_configuration(&self) -> Outcome<()> {
        let yaml = self.config.to_yaml();
        self.configuration.say(&ServoConfiguration {
            header: Header { stamp: self.host.now().into(), frame_id: self.config.frame_id.clone() },
            scene: self.scene_name.clone(),
            sha256: sha256(&yaml),
            yaml,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            record_version: TickRecord::VERSION,
        })
    }

    /// After the loop was told to stop: its last ticks, the last word on the wrench, and what it all came to.
    fn finish(mut self) -> Outcome<()> {
        let mut link = self.link.take();
        let Servo { handle, mut records, .. } = self.servo;
        let joined = handle.join();
        while let Some(tick) = records.pop() {
            self.topics.tick(&tick, records.dropped())?;
            for event in self.events.add(&tick) {
                self.contacts.say(&event)?;
            }
            self.last = tick;
        }
        self.topics.flush()?;
        if let Some(end) = self.events.finish(&self.last) {
            self.contacts.say(&end)?;
        }
        let ended = joined.map_err(|e| Failure::new(e.to_string()));
        if let Ok(status) = &ended {
            self.host.say(&format!(
                "ticks={} late={} lost={} wakeup: {}",
                status.ticks,
                status.late_ticks,
                status.records_dropped,
                status.wakeup.summary()
            ));
            self.host.say(&format!("tick: {}", status.compute.summary()));
        }
        // Again and again: these topics send a lost message no second time.
        for _ in 0..10 {
            let now = self.host.now();
            self.topics.say_no_force(now)?;
            if let Some(link) = &mut link {
                link.turn(now)?;
            }
            self.host.linger(Duration::from_millis(20));
        }
        ended.map(drop)
    }
}

/// Starts the loop on its thread.
fn spawn_loop(device: Box<dyn HapticDevice>, scene: &Scene, config: &Config, commands: Commands) -> Outcome<Servo> {
    let mut tick = Tick::new(scene, config);
    let device = Box::new(AlignedDevice::new(device, &config.mapping));
    let loop_config = LoopConfig {
        rate_hz: config.realtime.rate,
        thread: ThreadSetup {
            priority: u8::try_from(config.realtime.priority).unwrap_or(0),
            cpu: i32::try_from(config.realtime.cpu).unwrap_or(-1),
            lock_memory: config.realtime.lock_memory,
        },
        ..LoopConfig::default()
    };
    servo::spawn(device, move |input| tick.step(input), commands, &loop_config).map_err(|e| Failure::new(e.to_string()))
}
