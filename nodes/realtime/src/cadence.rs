use crate::clock::{monotonic_ns, sleep_until};

/// What a wake-up brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wakeup {
    /// The moment of the grid that this tick stands for, monotonic ns.
    pub scheduled_ns: i64,
    /// When the thread really woke, monotonic ns; never before `scheduled_ns`.
    pub woke_ns: i64,
    /// Grid moments passed over since the last tick, because it was late: no burst makes up for them.
    pub skipped: u64,
}

impl Wakeup {
    /// Wake-up latency, ns.
    #[must_use]
    pub const fn latency_ns(&self) -> u64 {
        let late = self.woke_ns - self.scheduled_ns;
        if late > 0 { late as u64 } else { 0 }
    }
}

/// A grid of moments one period apart on the monotonic clock.
///
/// A tick that comes late by whole periods stands for the newest moment that has passed; the ones between are skipped
/// and counted, and the grid itself never moves.
#[derive(Clone, Copy, Debug)]
pub struct Cadence {
    period_ns: i64,
    next_ns: i64,
}

impl Cadence {
    /// A grid that starts one period (ns, at least 1) after `start_ns`.
    #[must_use]
    pub const fn new(start_ns: i64, period_ns: i64) -> Self {
        let period_ns = if period_ns > 0 { period_ns } else { 1 };
        Self { period_ns, next_ns: start_ns + period_ns }
    }

    /// The period, ns.
    #[must_use]
    pub const fn period_ns(&self) -> i64 {
        self.period_ns
    }

    /// The next moment of the grid, monotonic ns.
    #[must_use]
    pub const fn next_ns(&self) -> i64 {
        self.next_ns
    }

    /// Sleeps until the next moment of the grid.
    pub fn wait(&mut self) -> Wakeup {
        sleep_until(self.next_ns);
        self.arrive(monotonic_ns())
    }

    /// What [`Cadence::wait`] returns for a thread that wakes at `woke_ns`.
    pub const fn arrive(&mut self, woke_ns: i64) -> Wakeup {
        let late = woke_ns - self.next_ns;
        let skipped = if late >= self.period_ns { late / self.period_ns } else { 0 };
        let scheduled_ns = self.next_ns + skipped * self.period_ns;
        self.next_ns = scheduled_ns + self.period_ns;
        Wakeup { scheduled_ns, woke_ns, skipped: skipped as u64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_ticks_make_no_burst_and_leave_the_grid_in_place() {
        let mut cadence = Cadence::new(0, 1_000);
        assert_eq!(cadence.arrive(1_010), Wakeup { scheduled_ns: 1_000, woke_ns: 1_010, skipped: 0 });
        // 3.5 periods late: stands for 5000, and the next one is 6000.
        let late = cadence.arrive(5_500);
        assert_eq!((late.scheduled_ns, late.skipped, late.latency_ns()), (5_000, 3, 500));
        assert_eq!(cadence.arrive(6_001).scheduled_ns, 6_000);
    }

    #[test]
    fn real_waits_keep_to_the_grid() {
        let start = monotonic_ns();
        let mut cadence = Cadence::new(start, 1_000_000);
        for _ in 0..20 {
            let w = cadence.wait();
            assert_eq!((w.scheduled_ns - start) % 1_000_000, 0);
            assert!(w.woke_ns >= w.scheduled_ns);
        }
    }
}
