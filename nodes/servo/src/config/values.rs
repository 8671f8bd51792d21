use device::OperatorConfig;
use haptics::Gains;
use spatial::DVec3;

/// Everything that can be set, in checked types: see [`schema`](super::schema) for units, ranges and meanings.
/// Live parameters are the ones in `gains`.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// `frame_id`.
    pub frame_id: String,
    /// `child_frame_id`.
    pub child_frame_id: String,
    /// `publish_rate`, Hz.
    pub publish_rate: f64,
    /// `scene`: a file or the name of an installed scene.
    pub scene: String,
    /// `law`, `gains.*`, `limits.*` and `passivity.enabled`.
    pub gains: Gains,
    /// `device.*`.
    pub device: DeviceConfig,
    /// `mapping.*`.
    pub mapping: MappingConfig,
    /// `jump.*`.
    pub jump: JumpConfig,
    /// `passivity.*`.
    pub passivity: PassivityConfig,
    /// `stability.*`.
    pub stability: StabilityConfig,
    /// `contacts.*`.
    pub contacts: ContactsConfig,
    /// `realtime.*`.
    pub realtime: RealtimeConfig,
}

/// Which device, and when its silence counts as failure.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceConfig {
    /// The driver.
    pub driver: Driver,
    /// Age at which a sample is stale, s.
    pub timeout: f64,
    /// `replay`: the poses.
    pub file: String,
    /// `spacemouse`: the hidraw device; empty for the first one found.
    pub path: String,
    /// `spacemouse`: speed at full deflection, m/s.
    pub speed: f64,
    /// `spacemouse`: angular speed at full deflection, rad/s.
    pub turn_speed: f64,
    /// `simulated`: the hand.
    pub operator: OperatorConfig,
}

/// `device.driver`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The simulated operator, in process.
    Simulated,
    /// Poses from a file, in process.
    Replay,
    /// A SpaceMouse, in process.
    SpaceMouse,
    /// Another node's `~/pose` and `~/joy`.
    Topic,
}

/// How the hand's motion becomes A's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MappingConfig {
    /// A's translation over the hand's.
    pub scale: f64,
    /// Button that holds A while the hand moves on; -1 for none.
    pub clutch_button: i64,
    /// Button that must be held for force; -1 for none.
    pub deadman_button: i64,
    /// Origin of the device's base frame in W, metres.
    pub xyz: DVec3,
    /// Orientation of the device's base frame in W, fixed-axis roll, pitch, yaw, rad.
    pub rpy: DVec3,
    /// Corner frequency of the velocity estimate, Hz.
    pub velocity_cutoff: f64,
}

/// What counts as a jump of the hand between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JumpConfig {
    /// Metres.
    pub distance: f64,
    /// Rad.
    pub angle: f64,
}

/// When a change of contact counts as one: live and in what is cut from a bag afterwards alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactsConfig {
    /// A contact state that lasts less is none, s.
    pub debounce: f64,
    /// A contact begins once the hand is this deep, metres; it ends when it is gone.
    pub min_depth: f64,
}

impl Default for ContactsConfig {
    fn default() -> Self {
        Self { debounce: 0.02, min_depth: 1e-7 }
    }
}

/// Bounds of the passivity controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassivityConfig {
    /// Greatest damping it adds, N.s/m.
    pub max_damping: f64,
    /// Lever by which rotation enters the account beside translation, metres.
    pub lever: f64,
    /// Energy given to the hand beyond what it has put in at which the force is reduced, J.
    pub budget: f64,
}

/// The check at start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityConfig {
    /// What to do about a bound that is not kept.
    pub check: StabilityPolicy,
    /// Damping of device and hand that can be counted on, N.s/m.
    pub damping: f64,
    /// Rotational damping of device and hand that can be counted on, N.m.s/rad.
    pub rotation_damping: f64,
    /// Mass of device and hand, kg.
    pub mass: f64,
    /// Moment of inertia of device and hand, kg.m^2.
    pub inertia: f64,
    /// Delay between measuring and showing beyond the hold, s.
    pub delay: f64,
    /// Step of the device's encoders, metres.
    pub resolution: f64,
    /// Step of the device's encoders for rotation, rad.
    pub angular_resolution: f64,
}

/// `stability.check`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StabilityPolicy {
    /// Say nothing.
    Off,
    /// Say so and go on.
    Warn,
    /// Say so and do not start.
    Refuse,
}

/// The servo thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealtimeConfig {
    /// Ticks a second.
    pub rate: f64,
    /// SCHED_FIFO priority; 0 for none.
    pub priority: i64,
    /// CPU to stay on; -1 for any.
    pub cpu: i64,
    /// Whether memory is locked.
    pub lock_memory: bool,
}

impl RealtimeConfig {
    /// Time of a tick, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        1.0 / self.rate
    }
}

impl Default for Config {
    fn default() -> Self {
        Self {
            frame_id: "world".into(),
            child_frame_id: "hand".into(),
            publish_rate: 50.0,
            scene: "peg_in_hole".into(),
            gains: Gains::default(),
            device: DeviceConfig {
                driver: Driver::Simulated,
                timeout: 0.01,
                file: String::new(),
                path: String::new(),
                speed: 0.1,
                turn_speed: 1.0,
                operator: OperatorConfig::default(),
            },
            mapping: MappingConfig {
                scale: 1.0,
                clutch_button: -1,
                deadman_button: -1,
                xyz: DVec3::ZERO,
                rpy: DVec3::ZERO,
                velocity_cutoff: 150.0,
            },
            jump: JumpConfig { distance: 0.02, angle: 0.2 },
            contacts: ContactsConfig::default(),
            passivity: PassivityConfig { max_damping: 20.0, lever: 0.03, budget: 2e-3 },
            stability: StabilityConfig {
                check: StabilityPolicy::Warn,
                damping: 3.0,
                rotation_damping: 5e-3,
                mass: 0.3,
                inertia: 3e-4,
                delay: 0.0,
                resolution: 1e-5,
                angular_resolution: 5e-5,
            },
            realtime: RealtimeConfig { rate: 1000.0, priority: 80, cpu: -1, lock_memory: true },
        }
    }
}
