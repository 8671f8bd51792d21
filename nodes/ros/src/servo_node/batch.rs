use bag::msg::{Header, TickBatch};
use bag::tick_to_msg;
use servo::TickRecord;
use spatial::Stamp;

/// Collects ticks into messages: at 1 kHz every tick is carried, ten in one message.
#[derive(Debug)]
pub struct Batcher {
    batch: TickBatch,
    size: usize,
    since: Option<Stamp>,
}

impl Batcher {
    /// The oldest tick of a batch waits no longer than this, ns.
    const PATIENCE_NS: i64 = 10_000_000;

    /// Batches of `size` ticks.
    #[must_use]
    pub fn new(frame_id: &str, child_frame_id: &str, size: usize) -> Self {
        let batch = TickBatch {
            header: Header { stamp: Stamp::default().into(), frame_id: frame_id.to_owned() },
            version: TickRecord::VERSION,
            child_frame_id: child_frame_id.to_owned(),
            ..Default::default()
        };
        Self { batch, size: size.max(1), since: None }
    }

    /// Adds a tick; `lost` counts those that the ring refused since the start. True if the batch should go.
    pub fn add(&mut self, tick: &TickRecord, lost: u64) -> bool {
        let since = *self.since.get_or_insert(tick.input.stamp);
        self.batch.header.stamp = tick.input.stamp.into();
        self.batch.lost = lost;
        self.batch.ticks.push(tick_to_msg(tick));
        self.batch.ticks.len() >= self.size || tick.input.stamp.0 - since.0 >= Self::PATIENCE_NS
    }

    /// The batch so far, if it holds a tick; [`Batcher::clear`] it once it is sent.
    #[must_use]
    pub fn batch(&self) -> Option<&TickBatch> {
        (!self.batch.ticks.is_empty()).then_some(&self.batch)
    }

    /// Begins anew, in the same memory.
    pub fn clear(&mut self) {
        self.batch.ticks.clear();
        self.since = None;
    }
}
