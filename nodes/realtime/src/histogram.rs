use hdrhistogram::Histogram;

/// Times in nanoseconds, from 1 ns to 10 s, to within 1 %. Recording, clearing and copying into another one allocate
/// nothing.
#[derive(Clone, Debug)]
pub struct LatencyHistogram {
    counts: Histogram<u64>,
    /// Exact, where the buckets round.
    max_ns: u64,
}

/// The figures of a [`LatencyHistogram`], ns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LatencySummary {
    /// How many were recorded.
    pub count: u64,
    /// Mean, ns.
    pub mean_ns: f64,
    /// Median, ns.
    pub p50_ns: u64,
    /// 99th percentile, ns.
    pub p99_ns: u64,
    /// 99.9th percentile, ns.
    pub p999_ns: u64,
    /// The greatest, ns.
    pub max_ns: u64,
}

impl LatencyHistogram {
    const HIGHEST_NS: u64 = 10_000_000_000;

    /// An empty histogram; the only call that allocates.
    #[must_use]
    pub fn new() -> Self {
        let mut counts = Histogram::new_with_bounds(1, Self::HIGHEST_NS, 2).expect("the bounds are constants in range");
        counts.auto(false);
        Self { counts, max_ns: 0 }
    }

    /// Counts one time; beyond 10 s it counts as 10 s (and `max_ns` keeps the true one).
    pub fn record(&mut self, ns: u64) {
        self.counts.saturating_record(ns);
        self.max_ns = self.max_ns.max(ns);
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.counts.reset();
        self.max_ns = 0;
    }

    /// Becomes a copy of `other`.
    pub fn copy_from(&mut self, other: &Self) {
        self.clear();
        self.add(other);
    }

    /// Takes `other`'s times in as well.
    pub fn add(&mut self, other: &Self) {
        // Every histogram here has the same bounds, so that this neither fails nor resizes.
        let _ = self.counts.add(&other.counts);
        self.max_ns = self.max_ns.max(other.max_ns);
    }

    /// The figures so far.
    #[must_use]
    pub fn summary(&self) -> LatencySummary {
        let at = |q| self.counts.value_at_quantile(q).min(self.max_ns);
        LatencySummary {
            count: self.counts.len(),
            mean_ns: self.counts.mean(),
            p50_ns: at(0.5),
            p99_ns: at(0.99),
            p999_ns: at(0.999),
            max_ns: self.max_ns,
        }
    }
}

impl Default for LatencyHistogram {
    fn default() -> Self {
        Self::new()
    }
}

impl std::fmt::Display for LatencySummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let us = |ns: u64| ns as f64 * 1e-3;
        write!(
            f,
            "mean {:.1} us, p50 {:.1}, p99 {:.1}, p99.9 {:.1}, max {:.1} (n = {})",
            self.mean_ns * 1e-3,
            us(self.p50_ns),
            us(self.p99_ns),
            us(self.p999_ns),
            us(self.max_ns),
            self.count
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_within_one_percent() {
        let mut h = LatencyHistogram::new();
        for ns in 1..=100_000 {
            h.record(ns);
        }
        let s = h.summary();
        for (got, want) in [(s.p50_ns, 50_000.0), (s.p99_ns, 99_000.0), (s.p999_ns, 99_900.0)] {
            assert!((got as f64 / want - 1.0).abs() < 0.01, "{got} for {want}");
        }
        assert_eq!((s.count, s.max_ns), (100_000, 100_000));
    }

    #[test]
    fn a_copy_has_the_same_figures_and_an_hour_does_not_overflow() {
        let mut h = LatencyHistogram::new();
        h.record(3_600_000_000_000);
        h.record(7);
        let mut copy = LatencyHistogram::new();
        copy.record(1);
        copy.copy_from(&h);
        assert_eq!(copy.summary(), h.summary());
        assert_eq!(copy.summary().max_ns, 3_600_000_000_000);
        copy.clear();
        assert_eq!(copy.summary().count, 0);
    }
}
