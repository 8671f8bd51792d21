use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A wait-free ring from one thread to another with place for `capacity` values. A full ring takes nothing and counts.
#[must_use]
pub fn ring<T: Send>(capacity: usize) -> (RingWriter<T>, RingReader<T>) {
    let (producer, consumer) = rtrb::RingBuffer::new(capacity);
    let dropped = Arc::new(AtomicU64::new(0));
    (RingWriter { producer, dropped: Arc::clone(&dropped) }, RingReader { consumer, dropped })
}

/// A [`ring`] whose memory was written once, with copies of `filler`, so that the real-time side faults no page in later.
#[must_use]
pub fn ring_prefaulted<T: Send + Clone>(capacity: usize, filler: &T) -> (RingWriter<T>, RingReader<T>) {
    let (mut writer, mut reader) = ring(capacity);
    while writer.producer.push(filler.clone()).is_ok() {}
    while reader.pop().is_some() {}
    (writer, reader)
}

/// The writing end of [`ring`].
#[derive(Debug)]
pub struct RingWriter<T> {
    producer: rtrb::Producer<T>,
    dropped: Arc<AtomicU64>,
}

impl<T> RingWriter<T> {
    /// Puts a value in; false if the ring is full, then it is dropped and counted.
    pub fn push(&mut self, value: T) -> bool {
        let taken = self.producer.push(value).is_ok();
        if !taken {
            // A lone counter: nothing else is published through it, so relaxed is enough.
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
        taken
    }

    /// How many values a full ring has refused.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }
}

/// The reading end of [`ring`].
#[derive(Debug)]
pub struct RingReader<T> {
    consumer: rtrb::Consumer<T>,
    dropped: Arc<AtomicU64>,
}

impl<T> RingReader<T> {
    /// Takes the oldest value, if there is one.
    pub fn pop(&mut self) -> Option<T> {
        self.consumer.pop().ok()
    }

    /// How many values wait.
    #[must_use]
    pub fn len(&self) -> usize {
        self.consumer.slots()
    }

    /// Whether none waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.consumer.is_empty()
    }

    /// Whether the writer is gone; what still waits can be taken.
    #[must_use]
    pub fn is_abandoned(&self) -> bool {
        self.consumer.is_abandoned()
    }

    /// How many values a full ring has refused.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_ring_keeps_the_old_and_counts_the_new() {
        let (mut writer, mut reader) = ring(3);
        let taken: Vec<bool> = (0..5).map(|n| writer.push(n)).collect();
        assert_eq!(taken, [true, true, true, false, false]);
        assert_eq!((reader.len(), reader.dropped(), writer.dropped()), (3, 2, 2));
        assert_eq!([reader.pop(), reader.pop(), reader.pop(), reader.pop()], [Some(0), Some(1), Some(2), None]);
        assert!(writer.push(9));
        drop(writer);
        assert!(reader.is_abandoned() && !reader.is_empty());
        assert_eq!(reader.pop(), Some(9));
    }
}
