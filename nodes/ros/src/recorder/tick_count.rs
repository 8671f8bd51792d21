use bag::msg::TickBatch;
use std::collections::BTreeMap;

/// Counts ticks and the gaps between them, topic by topic.
#[derive(Clone, Debug, Default)]
pub struct TickCount {
    next: BTreeMap<String, u64>,
    /// Ticks recorded.
    pub ticks: u64,
    /// Ticks that are missing between the first and the last recorded one.
    pub lost: u64,
}

impl TickCount {
    /// Counts a batch.
    pub fn add(&mut self, topic: &str, batch: &TickBatch) {
        for tick in &batch.ticks {
            if let Some(next) = self.next.get(topic) {
                // A servo that was started again counts from 0: nothing was lost.
                self.lost += tick.sequence.saturating_sub(*next);
            }
            self.next.insert(topic.to_owned(), tick.sequence + 1);
            self.ticks += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batch(sequences: impl IntoIterator<Item = u64>) -> TickBatch {
        let ticks = sequences.into_iter().map(|sequence| bag::msg::TickRecord { sequence, ..Default::default() });
        TickBatch { ticks: ticks.collect(), ..Default::default() }
    }

    #[test]
    fn counts_what_is_missing_inside_and_between_batches() {
        let mut count = TickCount::default();
        count.add("/a", &batch([5, 6, 8]));
        count.add("/b", &batch([0, 1]));
        count.add("/a", &batch([11]));
        assert_eq!((count.ticks, count.lost), (6, 3));
        count.add("/a", &batch([0, 1]));
        assert_eq!((count.ticks, count.lost), (8, 3));
    }
}
