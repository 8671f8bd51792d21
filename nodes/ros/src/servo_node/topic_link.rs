use super::StampWatch;
use crate::{Listener, Outcome, Talker, qos};
use bag::msg::{Header, Joy, PoseStamped, TwistStamped, WrenchStamped};
use device::{DeviceSpec, TopicConfig, TopicDevice, TopicPort, topic_device};
use r2r::Node;
use spatial::Stamp;

/// The node's side of a device behind topics: any vendor's driver, or this project's `haptic_device` on another machine.
pub struct TopicLink {
    port: TopicPort,
    poses: Listener<PoseStamped>,
    twists: Listener<TwistStamped>,
    joys: Listener<Joy>,
    out: Talker<WrenchStamped>,
    frame_id: String,
    heard: bool,
    /// How old a sample may be, s, where stamps are trusted.
    trusted: Option<f64>,
    watch: StampWatch,
}

impl TopicLink {
    /// Subscribes to `haptic_device/pose`, `haptic_device/twist` and `haptic_device/joy` and offers
    /// `haptic_device/command/wrench`, to be remapped to the driver's names. Samples older than `timeout` seconds are stale.
    ///
    /// # Errors
    /// The middleware refuses a topic.
    pub fn open(node: &mut Node, config: TopicConfig, timeout: f64) -> Outcome<(TopicDevice, Self)> {
        let (device, port) = topic_device(DeviceSpec::force_feedback("topic"), config);
        let link = Self {
            port,
            poses: Listener::new(node, "haptic_device/pose", qos::sensor())?,
            twists: Listener::new(node, "haptic_device/twist", qos::sensor())?,
            joys: Listener::new(node, "haptic_device/joy", qos::sensor())?,
            out: Talker::new(node, "haptic_device/command/wrench", qos::sensor())?,
            frame_id: String::new(),
            heard: false,
            trusted: config.trust_stamps.then_some(timeout),
            watch: StampWatch::default(),
        };
        Ok((device, link))
    }

    /// Hands over what came since the last turn, and the newest wrench to the driver. Says in one line when the poses' stamps
    /// cannot be trusted as they should.
    ///
    /// # Errors
    /// The middleware refuses the wrench.
    pub fn turn(&mut self, now: Stamp) -> Outcome<Option<String>> {
        let mut warning = None;
        if let Some(joy) = self.joys.take_newest() {
            self.port.buttons(buttons(&joy.buttons));
        }
        if let Some(message) = self.twists.take_newest() {
            self.port.twist(message.twist.into());
        }
        while let Some(message) = self.poses.take() {
            let stamp: Stamp = message.header.stamp.into();
            warning = self.trusted.and_then(|timeout| self.watch.see(stamp, now, timeout)).or(warning);
            self.port.pose(message.pose.into(), stamp);
            self.frame_id = message.header.frame_id;
            self.heard = true;
        }
        // A driver that has not spoken is told nothing either.
        if self.heard {
            let header = Header { stamp: now.into(), frame_id: self.frame_id.clone() };
            self.out.say(&WrenchStamped { header, wrench: self.port.wrench().into() })?;
        }
        Ok(warning)
    }
}

/// The buttons of a joystick message as a mask, bit 0 the first.
fn buttons(pressed: &[i32]) -> u32 {
    pressed.iter().take(32).enumerate().fold(0, |mask, (i, b)| mask | (u32::from(*b != 0) << i))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buttons_become_bits() {
        assert_eq!(buttons(&[1, 0, 1]), 0b101);
        assert_eq!(buttons(&[1; 40]), u32::MAX);
    }
}
