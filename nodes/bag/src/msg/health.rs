use super::Header;
use serde::{Deserialize, Serialize};

/// `cspace_haptics_msgs/msg/ServoHealth`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ServoHealth {
    /// Stamp of this message.
    pub header: Header,
    /// Health bits of the last tick and those seen since the last message, see TickRecord.`HEALTH_*`.
    pub health: u32,
    /// Health bits of the last tick and those seen since the last message, see TickRecord.`HEALTH_*`.
    pub health_since: u32,
    /// Whether force is wanted (~/enable).
    pub enabled: bool,
    /// Whether the thread runs under a real-time policy (SCHED_FIFO).
    pub realtime: bool,
    /// Nominal period, s, > 0.
    pub period: f64,
    /// Ticks run since start, and those that came late by more than a period.
    pub ticks: u64,
    /// Ticks run since start, and those that came late by more than a period.
    pub ticks_late: u64,
    /// Records lost because the ring to ROS, or the ring to the pictures, was full.
    pub lost_ros: u64,
    /// Records lost because the ring to ROS, or the ring to the pictures, was full.
    pub lost_pictures: u64,
    /// Device samples that were duplicates or came out of order, and those that were lost or not finite.
    pub samples_repeated: u64,
    /// Device samples that were duplicates or came out of order, and those that were lost or not finite.
    pub samples_bad: u64,
    /// Wake-up latency against the planned time, ns: median, 99th percentile, largest since start.
    pub wakeup_p50_ns: u32,
    /// Wake-up latency against the planned time, ns: median, 99th percentile, largest since start.
    pub wakeup_p99_ns: u32,
    /// Wake-up latency against the planned time, ns: median, 99th percentile, largest since start.
    pub wakeup_max_ns: u32,
    /// Time spent computing a tick, ns: median, 99th percentile, largest since start.
    pub compute_p50_ns: u32,
    /// Time spent computing a tick, ns: median, 99th percentile, largest since start.
    pub compute_p99_ns: u32,
    /// Time spent computing a tick, ns: median, 99th percentile, largest since start.
    pub compute_max_ns: u32,
    /// Energy account of the passivity observer, J: what the hand has put in, less what the coupling holds; < 0 is owed.
    pub energy: f64,
    /// Penetration of the hand's pose, metres, >= 0, and the norm of the force on the hand, N, >= 0, at the last
    /// tick.
    pub depth: f64,
    /// Penetration of the hand's pose, metres, >= 0, and the norm of the force on the hand, N, >= 0, at the last
    /// tick.
    pub force: f64,
}
