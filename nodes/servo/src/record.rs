use crate::Health;
use device::Sample;
use haptics::{ContactFormation, Gains};
use spatial::{Pose, Stamp, Twist, Wrench};

/// All that a tick depends on besides its state: the tick is a pure function of (state, input), so a recorded input
/// renders the same bytes again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TickInput {
    /// Counts ticks from 0, without a gap.
    pub sequence: u64,
    /// Robot time of this tick.
    pub stamp: Stamp,
    /// Time since the last tick, s: the nominal period, or the measured one after a late tick.
    pub dt: f64,
    /// The newest device sample.
    pub sample: Sample,
    /// Gains of this tick.
    pub gains: Gains,
    /// Whether force is wanted (`~/enable`).
    pub enabled: bool,
    /// Counts `~/reset` calls; a change re-seeds.
    pub reset_count: u32,
    /// Health bits found outside the pure tick (late, ring full, clock step).
    pub outside: Health,
    /// Wrench measured at the robot, to be added to the hand's (bilateral teleoperation); zero if none.
    pub remote: Wrench,
}

/// One tick, whole: what bags, ROS and rerun are fed from. `Copy`, fixed size, versioned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickRecord {
    /// What went in.
    pub input: TickInput,
    /// The hand's pose of A in W after workspace mapping: the HIP is its translation.
    pub hip: Pose,
    /// Velocity of the hand after mapping, axes of W.
    pub twist: Twist,
    /// The surface contact pose (SCP), A in W.
    pub proxy: Pose,
    /// Penetration of the hand's pose, metres, `>= 0`.
    pub depth: f64,
    /// The contacts that take place.
    pub formation: ContactFormation,
    /// The law's own wrench.
    pub law_wrench: Wrench,
    /// What the device gets: after ramp, coupling damping, passivity and limits.
    pub out_wrench: Wrench,
    /// Energy account of the passivity observer, J: what the hand has put in, less what the coupling holds. `< 0` is owed: it
    /// would be given to the hand if it were let go of as it is.
    pub energy: f64,
    /// Health bits.
    pub health: Health,
    /// Wake-up latency of this tick, ns. Measured, not part of the pure function: left out of replay comparisons.
    pub wakeup_ns: u32,
    /// Time spent computing, ns. Measured, see `wakeup_ns`.
    pub compute_ns: u32,
}

impl TickRecord {
    /// Layout version of the record in bags and messages.
    pub const VERSION: u16 = 1;
}

impl Default for TickRecord {
    /// A record of nothing: no sample, no contact, no force.
    fn default() -> Self {
        Self {
            input: TickInput::default(),
            hip: Pose::IDENTITY,
            twist: Twist::ZERO,
            proxy: Pose::IDENTITY,
            depth: 0.0,
            formation: ContactFormation::FREE,
            law_wrench: Wrench::ZERO,
            out_wrench: Wrench::ZERO,
            energy: 0.0,
            health: Health::GOOD,
            wakeup_ns: 0,
            compute_ns: 0,
        }
    }
}
