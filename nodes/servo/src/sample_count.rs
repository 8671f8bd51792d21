use crate::{Health, TickRecord};
use device::Sample;
use spatial::Stamp;

/// Counts the device's samples that were of no use, each once however many ticks see it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SampleCount {
    /// Duplicates, and those that came out of order.
    pub repeated: u64,
    /// Those that were lost (their numbers were skipped), and those with NaN or a bad quaternion.
    pub bad: u64,
    seen: Option<(u64, Stamp, [u64; 7])>,
    /// The newest number that was in order.
    newest: u64,
}

impl SampleCount {
    /// Takes in a tick.
    pub fn add(&mut self, tick: &TickRecord) {
        let sample = &tick.input.sample;
        let id = id(sample);
        if sample.sequence == 0 || self.seen.replace(id) == Some(id) {
            return;
        }
        if tick.health.any(Health::SEQUENCE) {
            self.repeated += 1;
            return;
        }
        self.bad += u64::from(tick.health.any(Health::INVALID));
        let expected = self.newest.wrapping_add(1);
        // A device that was started anew counts from 1 again.
        if self.newest != 0 && sample.sequence > expected {
            self.bad += sample.sequence - expected;
        }
        self.newest = sample.sequence;
    }
}

/// What tells a sample from the last one, bit for bit: NaN is equal to itself.
fn id(sample: &Sample) -> (u64, Stamp, [u64; 7]) {
    let ([x, y, z], [qx, qy, qz, qw]) = (sample.pose.translation.to_array(), sample.pose.rotation.to_array());
    (sample.sequence, sample.stamp, [x, y, z, qx, qy, qz, qw].map(f64::to_bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tick(sequence: u64, ms: i64, health: Health) -> TickRecord {
        let mut tick = TickRecord { health, ..TickRecord::default() };
        (tick.input.sample.sequence, tick.input.sample.stamp) = (sequence, Stamp(ms * 1_000_000));
        tick
    }

    #[test]
    fn each_sample_counts_once() {
        let mut count = SampleCount::default();
        let good = Health::GOOD;
        for (sequence, ms, health, repeated, bad) in [
            (0, 0, good, 0, 0),
            (7, 1, good, 0, 0),
            (7, 1, good, 0, 0),
            (8, 2, good, 0, 0),
            (7, 1, Health::SEQUENCE, 1, 0),
            (7, 1, Health::SEQUENCE, 1, 0),
            (9, 3, good, 1, 0),
            (9, 4, Health::SEQUENCE, 2, 0),
            (10, 5, Health::INVALID, 2, 1),
            (10, 5, Health::INVALID, 2, 1),
            (14, 9, good, 2, 4),
            (1, 10, good, 2, 4),
            (2, 11, good, 2, 4),
        ] {
            count.add(&tick(sequence, ms, health));
            assert_eq!((count.repeated, count.bad), (repeated, bad), "sample {sequence} at {ms} ms");
        }
    }
}
