use rerun::time::TimeCell;
use rerun::{RecordingStream, TimeColumn};
use servo::TickRecord;

/// Time line that counts ticks.
pub(crate) const TICK: &str = "tick";
/// Time line of the robot's clock.
pub(crate) const ROBOT_TIME: &str = "robot_time";

/// Stamps from here on (1973) are moments of the calendar; smaller ones count from the start of a recorded motion.
const CALENDAR_FROM_NANOS: i64 = 100_000_000_000_000_000;

/// The two time lines of a recording. Their kinds are settled by the first record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    calendar: bool,
}

impl Clock {
    pub(crate) fn new(first: &TickRecord) -> Self {
        Self { calendar: first.input.stamp.0 >= CALENDAR_FROM_NANOS }
    }

    /// Sets the stream's time for the calls that follow on this thread.
    pub(crate) fn set(&self, stream: &RecordingStream, record: &TickRecord) {
        stream.set_time_sequence(TICK, record.input.sequence as i64);
        let nanos = record.input.stamp.0;
        let cell = if self.calendar {
            TimeCell::from_timestamp_nanos_since_epoch(nanos)
        } else {
            TimeCell::from_duration_nanos(nanos)
        };
        stream.set_time(ROBOT_TIME, cell);
    }

    /// The time columns of a batch.
    pub(crate) fn columns(&self, ticks: &[i64], nanos: &[i64]) -> [TimeColumn; 2] {
        let nanos = nanos.iter().copied();
        let robot = if self.calendar {
            TimeColumn::new_timestamp_nanos_since_epoch(ROBOT_TIME, nanos)
        } else {
            TimeColumn::new_duration_nanos(ROBOT_TIME, nanos)
        };
        [TimeColumn::new_sequence(TICK, ticks.iter().copied()), robot]
    }
}
