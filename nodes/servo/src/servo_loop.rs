use crate::sample_count::SampleCount;
use crate::{Commands, Health, LoopStatus, TickInput, TickRecord};
use device::HapticDevice;
use realtime::{
    Cadence, LatestReader, LatestWriter, RingWriter, RobotClock, Wakeup, monotonic_ns, realtime_ns, sleep_until,
};
use spatial::{Stamp, Wrench};
use std::sync::atomic::{AtomicBool, Ordering};

/// The loop itself: owns the device and the tick, runs on the servo thread, and knows nothing of who reads its rings.
pub(crate) struct ServoLoop<S> {
    pub(crate) device: Box<dyn HapticDevice>,
    pub(crate) step: S,
    pub(crate) commands: LatestReader<Commands>,
    pub(crate) records: RingWriter<TickRecord>,
    pub(crate) pictures: RingWriter<TickRecord>,
    pub(crate) status_cell: LatestWriter<LoopStatus>,
    pub(crate) status: LoopStatus,
    pub(crate) samples: SampleCount,
    pub(crate) period_ns: i64,
}

/// How often the histograms are published, ns.
const STATUS_NS: i64 = 500_000_000;
/// A slower loop looks at the stop flag in between, so that force is off within 2 ms.
const STOP_CHECK_NS: i64 = 1_000_000;
/// Two clock readings further apart than this were torn by preemption and tell nothing of the wall clock.
const TORN_NS: i64 = 100_000;

impl<S: FnMut(&TickInput) -> TickRecord> ServoLoop<S> {
    /// Runs until `stop`, then leaves the device without force. No allocation, lock or system call but the sleep.
    pub(crate) fn run(&mut self, stop: &AtomicBool) {
        let start_ns = monotonic_ns();
        let mut cadence = Cadence::new(start_ns, self.period_ns);
        let mut clock = RobotClock::new(start_ns, realtime_ns());
        let mut sequence = 0;
        let mut outside = Health::GOOD;
        let mut last_woke_ns = start_ns;
        let mut next_status_ns = start_ns + STATUS_NS;
        while let Some(wakeup) = self.sleep(&mut cadence, stop) {
            outside.set(self.note_wakeup(&wakeup, last_woke_ns));
            if follow(&mut clock, wakeup.woke_ns, wakeup.woke_ns - last_woke_ns) {
                self.status.clock_steps += 1;
                outside.set(Health::CLOCK_STEP);
            }
            last_woke_ns = wakeup.woke_ns;
            let ring_full = self.tick(&wakeup, sequence, Stamp(clock.at(wakeup.scheduled_ns)), outside);
            outside = if ring_full { Health::RING_FULL } else { Health::GOOD };
            sequence += 1;
            if wakeup.woke_ns >= next_status_ns {
                next_status_ns = wakeup.woke_ns + STATUS_NS;
                self.publish_status();
            }
        }
        self.device.write(&Wrench::ZERO);
        self.publish_status();
    }

    /// Sleeps until the next moment of the grid; `None` if the loop shall stop.
    fn sleep(&self, cadence: &mut Cadence, stop: &AtomicBool) -> Option<Wakeup> {
        let stopped = || stop.load(Ordering::Acquire); // pairs with the store in `ServoHandle::stop`
        if self.period_ns > 2 * STOP_CHECK_NS {
            let end_ns = cadence.next_ns();
            let mut slice_ns = monotonic_ns() + STOP_CHECK_NS;
            while slice_ns < end_ns && !stopped() {
                sleep_until(slice_ns);
                slice_ns += STOP_CHECK_NS;
            }
        }
        if stopped() {
            return None;
        }
        let wakeup = cadence.wait();
        if stopped() { None } else { Some(wakeup) }
    }

    fn note_wakeup(&mut self, wakeup: &Wakeup, last_woke_ns: i64) -> Health {
        let status = &mut self.status;
        status.ticks += 1;
        status.wakeup.record(wakeup.latency_ns() + wakeup.skipped * self.period_ns as u64);
        if status.ticks > 1 {
            status.period.record((wakeup.woke_ns - last_woke_ns).max(0) as u64);
        }
        if wakeup.skipped == 0 {
            return Health::GOOD;
        }
        status.late_ticks += 1;
        status.skipped += wakeup.skipped;
        Health::LATE
    }

    /// One tick; true if a ring was full.
    fn tick(&mut self, wakeup: &Wakeup, sequence: u64, stamp: Stamp, outside: Health) -> bool {
        let commands = *self.commands.read();
        let sample = self.device.read(stamp);
        let input = TickInput {
            sequence,
            stamp,
            dt: (1 + wakeup.skipped) as f64 * self.period_ns as f64 * 1e-9,
            sample,
            gains: commands.gains,
            enabled: commands.enabled,
            reset_count: commands.reset_count,
            outside,
            remote: commands.remote,
        };
        let mut record = (self.step)(&input);
        self.device.write(&record.out_wrench);
        let compute_ns = (monotonic_ns() - wakeup.woke_ns).max(0) as u64;
        self.status.compute.record(compute_ns);
        self.samples.add(&record);
        record.wakeup_ns = saturate(wakeup.latency_ns() + wakeup.skipped * self.period_ns as u64);
        record.compute_ns = saturate(compute_ns);
        let to_records = self.records.push(record);
        let to_pictures = self.pictures.push(record);
        !(to_records && to_pictures)
    }

    fn publish_status(&mut self) {
        self.status.records_dropped = self.records.dropped();
        self.status.pictures_dropped = self.pictures.dropped();
        self.status.samples_repeated = self.samples.repeated;
        self.status.samples_bad = self.samples.bad;
        self.status_cell.write_with(|cell| cell.copy_from(&self.status));
    }
}

fn saturate(ns: u64) -> u32 {
    u32::try_from(ns).unwrap_or(u32::MAX)
}

/// Lets robot time follow the wall clock; true if that stepped.
fn follow(clock: &mut RobotClock, woke_ns: i64, elapsed_ns: i64) -> bool {
    let real_ns = realtime_ns();
    let after_ns = monotonic_ns();
    after_ns - woke_ns < TORN_NS && clock.follow(woke_ns + (after_ns - woke_ns) / 2, real_ns, elapsed_ns)
}
