use spatial::Stamp;

/// Log times that never go back: readers sort a bag by them, and a clock that steps back would put what came later
/// before what came first. From such a step on, log times go on at the clock's pace from where they were; the messages'
/// own stamps are left as they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct LogClock {
    last: Stamp,
    ahead_ns: i64,
}

impl LogClock {
    /// The log time at the clock's `now`, and by how many seconds the clock has stepped back, if it has.
    pub fn at(&mut self, now: Stamp) -> (Stamp, Option<f64>) {
        let log = Stamp(now.0.saturating_add(self.ahead_ns));
        let back_ns = self.last.0.saturating_sub(log.0);
        if back_ns <= 0 {
            self.last = log;
            return (log, None);
        }
        self.ahead_ns = self.ahead_ns.saturating_add(back_ns);
        (self.last, Some(back_ns as f64 / 1e9))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_steps_back_puts_nothing_before_what_came_first() {
        let mut clock = LogClock::default();
        let said = [100, 110, 50, 60, 70, 20, 30].map(|s| clock.at(Stamp(s * 1_000_000_000)));
        assert_eq!(said.map(|(at, _)| at.0 / 1_000_000_000), [100, 110, 110, 120, 130, 130, 140]);
        assert_eq!(said.map(|(_, back)| back), [None, None, Some(60.0), None, None, Some(50.0), None]);
    }

    #[test]
    fn a_clock_that_steps_ahead_is_followed() {
        let mut clock = LogClock::default();
        clock.at(Stamp(5));
        assert_eq!(clock.at(Stamp(4_000_000_000)), (Stamp(4_000_000_000), None));
        assert_eq!(clock.at(Stamp(i64::MAX)), (Stamp(i64::MAX), None));
        assert_eq!(clock.at(Stamp(i64::MIN)).0, Stamp(i64::MAX), "no overflow");
    }
}
