use realtime::LatencyHistogram;

/// How the loop has fared since its start.
#[derive(Clone, Debug, Default)]
pub struct LoopStatus {
    /// Ticks run.
    pub ticks: u64,
    /// Ticks that came late by a period or more.
    pub late_ticks: u64,
    /// Moments of the grid passed over by late ticks.
    pub skipped: u64,
    /// Records refused by the full ring to ROS.
    pub records_dropped: u64,
    /// Records refused by the full ring to the pictures.
    pub pictures_dropped: u64,
    /// Steps of the wall clock.
    pub clock_steps: u64,
    /// Samples of the device that were duplicates or came out of order.
    pub samples_repeated: u64,
    /// Samples of the device that were lost or not finite.
    pub samples_bad: u64,
    /// From the scheduled moment to the thread's first instruction.
    pub wakeup: LatencyHistogram,
    /// From wake-up until the wrench is with the device.
    pub compute: LatencyHistogram,
    /// From wake-up to wake-up.
    pub period: LatencyHistogram,
}

impl LoopStatus {
    /// Becomes a copy of `other`, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        let Self {
            ticks,
            late_ticks,
            skipped,
            records_dropped,
            pictures_dropped,
            clock_steps,
            samples_repeated,
            samples_bad,
            wakeup,
            compute,
            period,
        } = self;
        *ticks = other.ticks;
        *late_ticks = other.late_ticks;
        *skipped = other.skipped;
        *records_dropped = other.records_dropped;
        *pictures_dropped = other.pictures_dropped;
        *clock_steps = other.clock_steps;
        *samples_repeated = other.samples_repeated;
        *samples_bad = other.samples_bad;
        wakeup.copy_from(&other.wakeup);
        compute.copy_from(&other.compute);
        period.copy_from(&other.period);
    }
}
