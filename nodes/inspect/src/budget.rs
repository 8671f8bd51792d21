/// Bytes that may be spent on something in robot time: a token bucket. Driven by stamps, not by a clock, so that the
/// same run makes the same recording.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    per_second: f64,
    saved: f64,
    last: Option<f64>,
}

impl Budget {
    /// So many bytes a second, of which two seconds' worth can be saved up.
    pub(crate) fn new(per_second: f64) -> Self {
        Self { per_second, saved: 2.0 * per_second, last: None }
    }

    /// Whether `bytes` can be spent at time `now` (s). Anything may be spent while something is left, so that a
    /// picture larger than the savings still appears, and later ones wait until it is paid off.
    pub(crate) fn spend(&mut self, now: f64, bytes: usize) -> bool {
        let passed = self.last.map_or(0.0, |last| (now - last).max(0.0));
        self.last = Some(now);
        self.saved = (self.saved + passed * self.per_second).min(2.0 * self.per_second);
        let granted = self.saved > 0.0;
        if granted {
            self.saved -= bytes as f64;
        }
        granted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_average_stays_below_the_rate() {
        let mut budget = Budget::new(1000.0);
        let spent: usize = (0..6000).filter(|i| budget.spend(f64::from(*i) * 0.01, 300)).count() * 300;
        assert!(spent <= 60 * 1000 + 2300, "{spent}");
        assert!(spent >= 59_000, "{spent}");
    }

    #[test]
    fn a_picture_larger_than_the_savings_still_appears() {
        let mut budget = Budget::new(10.0);
        assert!(budget.spend(0.0, 1_000));
        assert!(!budget.spend(1.0, 1));
        assert!(budget.spend(200.0, 1));
    }
}
