use crate::{Failure, Inbox, Outcome};
use bag::cdr;
use bag::msg::Message;
use r2r::{Node, PublisherUntyped, QosProfile};
use std::marker::PhantomData;

/// Publishes messages of this project's own types: the same encoder fills bags and topics, so that what is recorded
/// live and what the offline program writes are the same bytes.
#[derive(Debug)]
pub struct Talker<M> {
    raw: PublisherUntyped,
    kind: PhantomData<fn(M)>,
}

impl<M: Message> Talker<M> {
    /// Offers `topic`.
    ///
    /// # Errors
    /// An impossible topic name, or a message type that the sourced ROS did not have when this program was built.
    pub fn new(node: &mut Node, topic: &str, qos: QosProfile) -> Outcome<Self> {
        let raw = node
            .create_publisher_untyped(topic, M::NAME, qos)
            .map_err(|e| Failure::new(format!("topic `{topic}` ({}) cannot be offered: {e}", M::NAME)))?;
        Ok(Self { raw, kind: PhantomData })
    }

    /// Publishes.
    ///
    /// # Errors
    /// If the message cannot be encoded or the middleware refuses it.
    pub fn say(&self, message: &M) -> Outcome<()> {
        let bytes = cdr::encode(message).map_err(|e| Failure::new(e.to_string()))?;
        Ok(self.raw.publish_raw(&bytes)?)
    }

    /// How many readers there are.
    #[must_use]
    pub fn listeners(&self) -> usize {
        self.raw.get_inter_process_subscription_count().unwrap_or(0)
    }
}

/// Hears messages of this project's own types.
pub struct Listener<M> {
    raw: Inbox<Vec<u8>>,
    refused: u64,
    kind: PhantomData<fn() -> M>,
}

impl<M: Message> Listener<M> {
    /// Subscribes to `topic`.
    ///
    /// # Errors
    /// An impossible topic name, or a message type that the sourced ROS did not have when this program was built.
    pub fn new(node: &mut Node, topic: &str, qos: QosProfile) -> Outcome<Self> {
        let raw = node
            .subscribe_raw(topic, M::NAME, qos)
            .map_err(|e| Failure::new(format!("topic `{topic}` ({}) cannot be heard: {e}", M::NAME)))?;
        Ok(Self { raw: Inbox::new(raw), refused: 0, kind: PhantomData })
    }

    /// The oldest message that waits; one that cannot be read is counted and passed over.
    pub fn take(&mut self) -> Option<M> {
        while let Some(bytes) = self.raw.take() {
            match cdr::decode(&bytes) {
                Ok(message) => return Some(message),
                Err(_) => self.refused += 1,
            }
        }
        None
    }

    /// The newest message that waits; older ones are dropped.
    pub fn take_newest(&mut self) -> Option<M> {
        let mut newest = None;
        while let Some(message) = self.take() {
            newest = Some(message);
        }
        newest
    }

    /// How many messages could not be read.
    #[must_use]
    pub const fn refused(&self) -> u64 {
        self.refused
    }
}
