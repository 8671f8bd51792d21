//! Quality of service by purpose.

use r2r::QosProfile;
use r2r::qos::{DurabilityPolicy, HistoryPolicy, ReliabilityPolicy};

/// Poses, twists and wrenches: the newest counts, a lost one is not asked for again.
#[must_use]
pub fn sensor() -> QosProfile {
    QosProfile::sensor_data()
}

/// Tick batches: reliable, and kept for ten seconds at a hundred batches a second: a reader may be away that long, and a
/// recorder that discovers the servo late still gets its first tick.
#[must_use]
pub fn every_tick() -> QosProfile {
    latched(1000)
}

/// Events of contact: reliable, a late joiner gets the last ones at once. An end and a begin come in one breath: of a
/// single one kept, what the network loses could not be sent again.
#[must_use]
pub fn events() -> QosProfile {
    latched(10)
}

/// What a late joiner must have: the last `depth` messages are kept for it.
#[must_use]
pub fn latched(depth: usize) -> QosProfile {
    QosProfile {
        history: HistoryPolicy::KeepLast,
        depth,
        reliability: ReliabilityPolicy::Reliable,
        durability: DurabilityPolicy::TransientLocal,
        ..QosProfile::default()
    }
}

/// The subscription that gets most out of these offers: it asks for no more than every publisher gives, for a reader
/// that asks for more than one of them gives does not hear that one at all.
#[must_use]
pub fn matching(offers: &[QosProfile]) -> QosProfile {
    let reliable = !offers.is_empty() && offers.iter().all(|o| matches!(o.reliability, ReliabilityPolicy::Reliable));
    let latched = !offers.is_empty() && offers.iter().all(|o| matches!(o.durability, DurabilityPolicy::TransientLocal));
    QosProfile {
        history: HistoryPolicy::KeepLast,
        depth: 1000,
        reliability: if reliable { ReliabilityPolicy::Reliable } else { ReliabilityPolicy::BestEffort },
        durability: if latched { DurabilityPolicy::TransientLocal } else { DurabilityPolicy::Volatile },
        ..QosProfile::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_asks_for_no_more_than_all_offers_give() {
        assert_eq!(matching(&[latched(1)]).durability, DurabilityPolicy::TransientLocal);
        let mixed = matching(&[latched(1), sensor()]);
        assert_eq!((mixed.reliability, mixed.durability), (ReliabilityPolicy::BestEffort, DurabilityPolicy::Volatile));
        assert_eq!(matching(&[every_tick()]).reliability, ReliabilityPolicy::Reliable);
    }
}
