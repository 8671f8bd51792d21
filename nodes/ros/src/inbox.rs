use futures::{FutureExt, Stream, StreamExt};

/// What a subscription or service has received.
///
/// The channel behind it holds ten and drops the newest when full, and one turn of the node adds at most one: drain it
/// after every turn and nothing is lost.
pub struct Inbox<T>(Box<dyn Stream<Item = T> + Unpin + Send>);

impl<T> Inbox<T> {
    /// Over a subscription's or service's stream.
    #[must_use]
    pub fn new(stream: impl Stream<Item = T> + Unpin + Send + 'static) -> Self {
        Self(Box::new(stream))
    }

    /// The oldest that waits.
    pub fn take(&mut self) -> Option<T> {
        self.0.next().now_or_never().flatten()
    }

    /// The newest that waits; older ones are dropped.
    pub fn take_newest(&mut self) -> Option<T> {
        let mut newest = None;
        while let Some(message) = self.take() {
            newest = Some(message);
        }
        newest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_inbox_does_not_wait() {
        let (tx, rx) = futures::channel::mpsc::unbounded();
        let mut inbox = Inbox::new(rx);
        assert_eq!(inbox.take(), None);
        for i in 0..3 {
            tx.unbounded_send(i).unwrap();
        }
        assert_eq!(inbox.take(), Some(0));
        assert_eq!(inbox.take_newest(), Some(2));
        assert_eq!(inbox.take(), None);
    }
}
