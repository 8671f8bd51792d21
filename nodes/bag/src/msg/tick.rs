use super::{ContactPoint, Header, Pose, Time, Twist, Wrench};
use serde::{Deserialize, Serialize};

/// `cspace_haptics_msgs/msg/DeviceSample`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeviceSample {
    /// Counts samples from the device, from 1; 0 means that none has come yet.
    pub sequence: u64,
    /// When the device measured it.
    pub stamp: Time,
    /// Pose of the handle in the base frame: metres and unit quaternion.
    pub pose: Pose,
    /// Velocity of the handle, m/s and rad/s, axes of the base frame; zero if has_twist is false.
    pub twist: Twist,
    /// Whether the device measures velocity; else the servo differentiates.
    pub has_twist: bool,
    /// Button mask, bit 0 is the first button.
    pub buttons: u32,
    /// False while the device is unplugged or its last report was garbage.
    pub connected: bool,
}

/// `cspace_haptics_msgs/msg/Gains`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// One of LAW_*.
    pub law: u8,
    /// Stiffness of coupling and walls, N/m, >= 0.
    pub stiffness: f64,
    /// Coupling damping, N.s/m, >= 0.
    pub damping: f64,
    /// Rotational coupling stiffness, N.m/rad, >= 0 (LAW_PROXY).
    pub rotation_stiffness: f64,
    /// Rotational coupling damping, N.m.s/rad, >= 0.
    pub rotation_damping: f64,
    /// Depth over which a contact's weight fades, metres, > 0 (LAW_BLENDED).
    pub blend_depth: f64,
    /// Greatest force on the hand, N, >= 0.
    pub max_force: f64,
    /// Greatest torque on the hand, N.m, >= 0.
    pub max_torque: f64,
    /// Greatest change of force, N/s, > 0.
    pub max_force_rate: f64,
    /// Greatest change of torque, N.m/s, > 0.
    pub max_torque_rate: f64,
    /// Time of the ramp after enabling, s, >= 0.
    pub ramp_time: f64,
    /// Static Coulomb friction coefficient for obstacles that state none, >= 0; 0 is off.
    pub friction_static: f64,
    /// Kinetic Coulomb friction coefficient, 0 .. friction_static.
    pub friction_kinetic: f64,
    /// Whether the passivity controller acts (the observer always runs).
    pub passivity: bool,
    /// Greatest speed of the proxy, m/s, > 0; infinity is off.
    pub proxy_speed: f64,
}

/// `cspace_haptics_msgs/msg/TickRecord`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TickRecord {
    /// Counts ticks from 0, without a gap.
    pub sequence: u64,
    /// Time of the tick on the robot's clock (ROS time).
    pub stamp: Time,
    /// Time since the last tick, s, > 0: the nominal period, or the measured one after a late tick.
    pub dt: f64,
    /// The newest device sample.
    pub sample: DeviceSample,
    /// Gains of this tick.
    pub gains: Gains,
    /// Whether force is wanted (~/enable).
    pub enabled: bool,
    /// Counts ~/reset calls; a change seeds the tracker anew.
    pub reset_count: u32,
    /// Health bits found outside the pure tick (late, ring full, clock step).
    pub outside: u32,
    /// Wrench measured at the robot and added to the hand's: N and N.m, axes of W, torque about A's origin; zero if
    /// none.
    pub remote: Wrench,
    /// The hand's pose of A in W after workspace mapping: metres and unit quaternion; the HIP is its position.
    pub pose: Pose,
    /// Velocity of the hand after mapping, m/s and rad/s, axes of W.
    pub twist: Twist,
    /// The surface contact pose (SCP), A in W: what a robot should follow; equal to pose when free.
    pub proxy_pose: Pose,
    /// Penetration of the hand's pose, metres, >= 0.
    pub depth: f64,
    /// Formation of the whole body, one of PrincipalContact.KIND_*.
    pub kind: u8,
    /// The basic contacts that take place, at most the 16 deepest.
    pub contacts: Vec<ContactPoint>,
    /// The law's own wrench on the hand: N and N.m, axes of W, torque about A's origin.
    pub law_wrench: Wrench,
    /// What the device gets, after ramp, coupling damping, passivity and limits; axes and reference point as above.
    pub out_wrench: Wrench,
    /// Energy account of the passivity observer, J: what the hand has put in, less what the coupling holds; < 0 is owed.
    pub energy: f64,
    /// Health bits of the tick, `HEALTH_*`.
    pub health: u32,
    /// Wake-up latency and time spent computing, ns. Measured, not part of the pure function: left out of
    /// comparisons.
    pub wakeup_ns: u32,
    /// Wake-up latency and time spent computing, ns. Measured, not part of the pure function: left out of
    /// comparisons.
    pub compute_ns: u32,
}

/// `cspace_haptics_msgs/msg/TickBatch`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TickBatch {
    /// Stamp of the newest tick; frame W.
    pub header: Header,
    /// Layout version of TickRecord; a reader refuses a version that it does not know.
    pub version: u16,
    /// Ticks lost on the way to this message since the servo started.
    pub lost: u64,
    /// Frame of A, the child frame of the poses.
    pub child_frame_id: String,
    /// The ticks, oldest first.
    pub ticks: Vec<TickRecord>,
}
