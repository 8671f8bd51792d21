//! Thread set-up, clock, latency histogram, rings and latest-value cells: all that a real-time loop needs from the
//! system, asked for once at the start, so that the loop itself does nothing but its work and one sleep.

mod cadence;
mod clearance;
mod clock;
mod histogram;
mod idle;
mod latest;
mod ring;
mod thread_setup;

pub use cadence::{Cadence, Wakeup};
pub use clock::{RobotClock, monotonic_ns, realtime_ns, sleep_until};
pub use histogram::{LatencyHistogram, LatencySummary};
pub use latest::{LatestReader, LatestWriter, latest};
pub use ring::{RingReader, RingWriter, ring, ring_prefaulted};
pub use thread_setup::{Grant, GrantReport, ThreadSetup};
