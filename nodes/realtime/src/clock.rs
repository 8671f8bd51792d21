use rustix::thread::{ClockId, Timespec, clock_nanosleep_absolute};
use rustix::time::clock_gettime;

const NS: i64 = 1_000_000_000;

/// `CLOCK_MONOTONIC`, nanoseconds. Read in the vDSO: no system call.
#[must_use]
pub fn monotonic_ns() -> i64 {
    nanoseconds(clock_gettime(ClockId::Monotonic))
}

/// `CLOCK_REALTIME`, nanoseconds since 1970: what ROS calls system time. No system call either.
#[must_use]
pub fn realtime_ns() -> i64 {
    nanoseconds(clock_gettime(ClockId::Realtime))
}

/// Sleeps until `deadline_ns` on the monotonic clock; returns at once if it has passed. The time is absolute, so a late
/// wake-up does not push the following ones, and an interrupted sleep resumes without drift.
pub fn sleep_until(deadline_ns: i64) {
    let request = Timespec { tv_sec: deadline_ns.div_euclid(NS), tv_nsec: deadline_ns.rem_euclid(NS) };
    while let Err(rustix::io::Errno::INTR) = clock_nanosleep_absolute(ClockId::Monotonic, &request) {}
}

fn nanoseconds(t: Timespec) -> i64 {
    t.tv_sec * NS + t.tv_nsec
}

/// Robot time (ROS system time) for stamps, carried by the monotonic clock.
///
/// The distance between the two clocks is read once and then followed slowly, so that stamps stay strictly rising and
/// evenly spaced while NTP slews the wall clock. A step of the wall clock is adopted at once, and reported: every other
/// node of the system has stepped too.
#[derive(Clone, Copy, Debug)]
pub struct RobotClock {
    offset_ns: i64,
}

impl RobotClock {
    /// A difference beyond this is a step, not a drift or a reading torn by preemption: 50 ms.
    pub const STEP_NS: i64 = 50_000_000;
    /// The greatest correction in one update: one part in 2000 of the time since the last one.
    const SLEW_DIVISOR: i64 = 2000;

    /// A clock whose offset is the difference of these two readings, taken one right after the other.
    #[must_use]
    pub const fn new(monotonic_ns: i64, realtime_ns: i64) -> Self {
        Self { offset_ns: realtime_ns - monotonic_ns }
    }

    /// A clock set by the system's clocks now.
    #[must_use]
    pub fn now() -> Self {
        Self::new(monotonic_ns(), realtime_ns())
    }

    /// Robot time at a monotonic moment, ns since 1970.
    #[must_use]
    pub const fn at(&self, monotonic_ns: i64) -> i64 {
        monotonic_ns + self.offset_ns
    }

    /// Follows the wall clock: `elapsed_ns` since the last update bounds the correction. True if the wall clock stepped.
    pub fn follow(&mut self, monotonic_ns: i64, realtime_ns: i64, elapsed_ns: i64) -> bool {
        let error = (realtime_ns - monotonic_ns) - self.offset_ns;
        if error.abs() > Self::STEP_NS {
            self.offset_ns += error;
            return true;
        }
        let most = elapsed_ns.max(0) / Self::SLEW_DIVISOR;
        self.offset_ns += error.clamp(-most, most);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sleeps_no_less_than_asked() {
        let deadline = monotonic_ns() + 3_000_000;
        sleep_until(deadline);
        assert!(monotonic_ns() >= deadline);
        sleep_until(deadline - 1_000_000_000);
    }

    #[test]
    fn follows_a_drift_slowly_and_a_step_at_once() {
        let mut clock = RobotClock::new(0, 1_000);
        // The wall clock runs 1 ms ahead: 1 ms later at most 500 ns of it are taken over, and stamps still rise.
        assert!(!clock.follow(1_000_000, 2_001_000, 1_000_000));
        assert_eq!(clock.at(1_000_000), 1_001_500);
        // An hour back: adopted.
        assert!(clock.follow(2_000_000, -3_600_000_000_000, 1_000_000));
        assert_eq!(clock.at(2_000_000), -3_600_000_000_000);
        assert!(!clock.follow(3_000_000, -3_599_999_000_000, 1_000_000));
    }
}
