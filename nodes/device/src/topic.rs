use crate::{DeviceSpec, HapticDevice, Sample};
use serde::{Deserialize, Serialize};
use spatial::{Pose, Stamp, Twist, Wrench};
use triple_buffer::{Input, Output};

/// How far a topic's stamps are trusted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TopicConfig {
    /// Whether the sender's clock is this machine's, or synchronised to it: then a sample is as old as its stamp says.
    /// Otherwise its age counts from its arrival.
    pub trust_stamps: bool,
}

/// A device behind a topic: any vendor's driver that publishes poses and takes wrenches. Two latest-value cells, one each
/// way; the middleware's thread holds the other ends, a [`TopicPort`].
#[derive(Debug)]
pub struct TopicDevice {
    spec: DeviceSpec,
    config: TopicConfig,
    incoming: Output<Message>,
    outgoing: Input<Wrench>,
    arrivals: u64,
    arrived_at: Stamp,
}

/// So many poses in a row that are older than the newest, each later than the one before, are no late arrivals any more: the
/// sender's clock has started anew or was set back.
const CLOCK_RESTART: u32 = 20;

/// The middleware's side of a [`TopicDevice`].
#[derive(Debug)]
pub struct TopicPort {
    incoming: Input<Message>,
    outgoing: Output<Wrench>,
    newest: Message,
    out_of_order: u64,
    older: Older,
}

/// The run of poses that came last and are older than the newest, each later than the one before.
#[derive(Clone, Copy, Debug, Default)]
struct Older {
    stamp: Stamp,
    count: u32,
}

impl Older {
    /// The run with a pose of `stamp` after it.
    fn with(self, stamp: Stamp) -> Self {
        let goes_on = self.count > 0 && stamp > self.stamp;
        Self { stamp, count: if goes_on { self.count + 1 } else { 1 } }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Message {
    /// Counts poses that were taken.
    arrivals: u64,
    sequence: u64,
    stamp: Stamp,
    pose: Pose,
    twist: Option<Twist>,
    buttons: u32,
}

/// A device and the port that feeds it.
#[must_use]
pub fn topic_device(spec: DeviceSpec, config: TopicConfig) -> (TopicDevice, TopicPort) {
    let (to_device, incoming) = triple_buffer::triple_buffer(&Message::default());
    let (outgoing, from_device) = triple_buffer::triple_buffer(&Wrench::ZERO);
    let device = TopicDevice { spec, config, incoming, outgoing, arrivals: 0, arrived_at: Stamp(0) };
    let port = TopicPort {
        incoming: to_device,
        outgoing: from_device,
        newest: Message::default(),
        out_of_order: 0,
        older: Older::default(),
    };
    (device, port)
}

impl TopicPort {
    /// A pose came, measured at `stamp` by the sender's clock (`Stamp(0)` if it does not say). One that is not newer than
    /// the last is not taken: the sample repeats, as old as it is, with a sequence number that goes back, so that the tick
    /// reports it. Twenty such in a row, each later than the one before, tell of a driver that has started anew or of a
    /// clock that was set back: from then on they are taken.
    pub fn pose(&mut self, pose: Pose, stamp: Stamp) {
        let unstamped = stamp == Stamp(0) || self.newest.stamp == Stamp(0);
        let newer = unstamped || stamp > self.newest.stamp;
        self.older = if newer { Older::default() } else { self.older.with(stamp) };
        if newer || self.older.count >= CLOCK_RESTART {
            self.older = Older::default();
            let Message { arrivals, sequence, .. } = self.newest;
            self.newest = Message { arrivals: arrivals + 1, sequence: sequence + 1, stamp, pose, ..self.newest };
            self.incoming.write(self.newest);
        } else {
            self.out_of_order += 1;
            self.incoming.write(Message { sequence: self.newest.sequence.saturating_sub(1), ..self.newest });
        }
    }

    /// A velocity came; it goes with the next poses.
    pub fn twist(&mut self, twist: Twist) {
        self.newest.twist = Some(twist);
    }

    /// The buttons changed, bit 0 the first.
    pub fn buttons(&mut self, mask: u32) {
        self.newest.buttons = mask;
        self.incoming.write(self.newest);
    }

    /// The newest wrench for the hand.
    pub fn wrench(&mut self) -> Wrench {
        *self.outgoing.read()
    }

    /// Poses that were not newer than the one before.
    #[must_use]
    pub fn out_of_order(&self) -> u64 {
        self.out_of_order
    }
}

impl HapticDevice for TopicDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read(&mut self, now: Stamp) -> Sample {
        let message = *self.incoming.read();
        if message.arrivals != self.arrivals {
            self.arrivals = message.arrivals;
            self.arrived_at = now;
        }
        let trusted = self.config.trust_stamps && message.stamp != Stamp(0);
        Sample {
            sequence: message.sequence,
            stamp: if trusted { message.stamp.min(self.arrived_at) } else { self.arrived_at },
            pose: message.pose,
            twist: message.twist.unwrap_or(Twist::ZERO),
            has_twist: message.twist.is_some(),
            buttons: message.buttons,
            connected: message.sequence > 0,
        }
    }

    fn write(&mut self, wrench: &Wrench) {
        self.outgoing.write(*wrench);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DVec3;

    fn pair(trust_stamps: bool) -> (TopicDevice, TopicPort) {
        topic_device(DeviceSpec::force_feedback("topic"), TopicConfig { trust_stamps })
    }

    fn at(x: f64) -> Pose {
        Pose::new(DVec3::X * x, Pose::IDENTITY.rotation)
    }

    #[test]
    fn is_not_connected_before_the_first_pose() {
        let (mut device, mut port) = pair(false);
        assert!(!device.read(Stamp(5)).connected);
        port.buttons(1);
        assert!(!device.read(Stamp(6)).connected);
        port.pose(at(1.0), Stamp(0));
        assert!(device.read(Stamp(7)).connected);
    }

    #[test]
    fn a_silent_topic_ages_from_its_last_arrival() {
        let (mut device, mut port) = pair(false);
        port.pose(at(1.0), Stamp(900));
        assert_eq!(device.read(Stamp(1000)).stamp, Stamp(1000));
        assert_eq!(device.read(Stamp(5000)).stamp, Stamp(1000));
        port.buttons(3);
        let sample = device.read(Stamp(6000));
        assert_eq!((sample.stamp, sample.buttons, sample.sequence), (Stamp(1000), 3, 1), "a button is no pose");
    }

    #[test]
    fn trusted_stamps_tell_the_age_but_never_the_future() {
        let (mut device, mut port) = pair(true);
        port.pose(at(1.0), Stamp(900));
        assert_eq!(device.read(Stamp(1000)).stamp, Stamp(900));
        port.pose(at(1.0), Stamp(99_999));
        assert_eq!(device.read(Stamp(2000)).stamp, Stamp(2000));
    }

    #[test]
    fn duplicates_and_late_poses_go_back_in_sequence_and_move_nothing() {
        let (mut device, mut port) = pair(false);
        port.pose(at(1.0), Stamp(10));
        port.pose(at(2.0), Stamp(20));
        assert_eq!(device.read(Stamp(50)).sequence, 2);
        for stale in [20, 15] {
            port.pose(at(9.0), Stamp(stale));
            let sample = device.read(Stamp(100));
            assert_eq!((sample.sequence, sample.stamp, sample.pose), (1, Stamp(50), at(2.0)));
        }
        port.pose(at(3.0), Stamp(30));
        let sample = device.read(Stamp(101));
        assert_eq!((sample.sequence, sample.pose, port.out_of_order()), (3, at(3.0), 2));
    }

    #[test]
    fn a_clock_that_starts_anew_is_followed_after_a_while() {
        let (mut device, mut port) = pair(false);
        port.pose(at(1.0), Stamp(3_600_000));
        for late in 1..i64::from(CLOCK_RESTART) {
            port.pose(at(2.0), Stamp(late));
            assert_eq!(device.read(Stamp(late)).pose, at(1.0));
        }
        port.pose(at(3.0), Stamp(100));
        let sample = device.read(Stamp(100));
        assert_eq!((sample.sequence, sample.stamp, sample.pose), (2, Stamp(100), at(3.0)));
        port.pose(at(4.0), Stamp(101));
        assert_eq!((device.read(Stamp(101)).pose, port.out_of_order()), (at(4.0), u64::from(CLOCK_RESTART) - 1));
    }

    #[test]
    fn a_frozen_driver_and_late_poses_among_others_are_no_new_clock() {
        let (mut device, mut port) = pair(false);
        port.pose(at(1.0), Stamp(1000));
        for _ in 0..2 * CLOCK_RESTART {
            port.pose(at(9.0), Stamp(1000));
            port.pose(at(9.0), Stamp(990));
        }
        for i in 0..2 * i64::from(CLOCK_RESTART) {
            port.pose(at(2.0), Stamp(1001 + i));
            port.pose(at(9.0), Stamp(901 + i));
        }
        assert_eq!(device.read(Stamp(5000)).pose, at(2.0));
    }

    #[test]
    fn wrenches_go_out_newest_first() {
        let (mut device, mut port) = pair(false);
        device.write(&Wrench::new(DVec3::X, DVec3::ZERO));
        device.write(&Wrench::new(DVec3::Y, DVec3::ZERO));
        assert_eq!(port.wrench().force, DVec3::Y);
    }
}
