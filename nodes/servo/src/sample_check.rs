use crate::Health;
use device::Sample;
use spatial::Stamp;

/// Looks at samples before anything else does.
#[derive(Clone, Copy, Debug)]
pub struct SampleCheck {
    timeout_ns: i64,
    last: Option<Sample>,
}

/// What a sample is worth.
#[derive(Clone, Copy, Debug)]
pub struct Checked {
    /// The newest good sample, which may be an older one; `None` before the first.
    pub sample: Option<Sample>,
    /// Whether it is new in this tick.
    pub fresh: bool,
    /// What is wrong, if anything.
    pub health: Health,
}

impl SampleCheck {
    /// A sample is stale when it is older than `timeout` seconds.
    #[must_use]
    pub fn new(timeout: f64) -> Self {
        Self { timeout_ns: (timeout * 1e9) as i64, last: None }
    }

    /// Checks the newest sample at time `now`.
    pub fn check(&mut self, sample: &Sample, now: Stamp) -> Checked {
        let mut health = Health::GOOD;
        if !sample.connected {
            health.set(Health::DISCONNECTED);
        }
        let finite = sample.pose.is_valid() && (!sample.has_twist || sample.twist.is_finite());
        if sample.sequence != 0 && !finite {
            health.set(Health::INVALID);
        }
        // After a silence anything is newer: the device's clock may have started anew.
        let silent = self.is_stale(now);
        let usable = sample.sequence != 0 && finite && sample.connected;
        let again = self.is_again(sample);
        let fresh = usable && !again && (silent || self.is_newer(sample, &mut health));
        if fresh {
            self.last = Some(*sample);
        }
        if self.is_stale(now) {
            health.set(Health::STALE);
        }
        Checked { sample: self.last, fresh, health }
    }

    /// A stamp far ahead is as little to be trusted as one far behind.
    fn is_stale(&self, now: Stamp) -> bool {
        let age_ns = |s: &Sample| now.0.saturating_sub(s.stamp.0).saturating_abs();
        self.last.as_ref().is_none_or(|s| age_ns(s) > self.timeout_ns)
    }

    /// The same sample again is normal where the servo is faster than the device. Its buttons may change meanwhile.
    fn is_again(&mut self, sample: &Sample) -> bool {
        let Some(last) = &mut self.last else { return false };
        let again = last.sequence == sample.sequence && is_one_measurement(last, sample);
        if again {
            last.buttons = sample.buttons;
        }
        again
    }

    /// A sample that goes back in time, another one under the same number, or the same one under a new number is not right.
    fn is_newer(&self, sample: &Sample, health: &mut Health) -> bool {
        let Some(last) = &self.last else { return true };
        // A lower number under a later stamp: the device started again.
        let later = (sample.stamp, sample.sequence) > (last.stamp, last.sequence);
        let repeated = is_one_measurement(last, sample);
        if sample.sequence == last.sequence || !later || repeated {
            health.set(Health::SEQUENCE);
        }
        later && !repeated
    }
}

/// Whether two samples are equal but for their numbers and buttons.
fn is_one_measurement(a: &Sample, b: &Sample) -> bool {
    let of = |s: &Sample| (s.stamp, s.connected, s.has_twist);
    of(a) == of(b) && a.pose == b.pose && a.twist == b.twist
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::{DQuat, DVec3, Pose};

    fn sample(sequence: u64, ms: i64) -> Sample {
        Sample { sequence, stamp: Stamp(ms * 1_000_000), connected: true, ..Default::default() }
    }

    fn at(ms: i64) -> Stamp {
        Stamp(ms * 1_000_000)
    }

    #[test]
    fn a_sample_goes_stale_and_comes_back() {
        let mut check = SampleCheck::new(0.01);
        assert_eq!(check.check(&Sample::default(), at(0)).health, Health::STALE | Health::DISCONNECTED);
        assert_eq!(check.check(&sample(1, 1), at(1)).health, Health::GOOD);
        assert_eq!(check.check(&sample(1, 1), at(11)).health, Health::GOOD);
        assert_eq!(check.check(&sample(1, 1), at(12)).health, Health::STALE);
        assert_eq!(check.check(&sample(2, 12), at(12)).health, Health::GOOD);
        assert_eq!(check.check(&sample(3, 99), at(13)).health, Health::STALE, "a stamp far ahead");
    }

    #[test]
    fn out_of_order_duplicate_and_garbage_are_told_apart_and_not_used() {
        let mut check = SampleCheck::new(0.01);
        check.check(&sample(5, 5), at(5));
        let old = check.check(&sample(4, 4), at(6));
        assert!(old.health == Health::SEQUENCE && !old.fresh && old.sample.unwrap().sequence == 5);
        assert_eq!(check.check(&sample(5, 6), at(6)).health, Health::SEQUENCE);
        let restarted = check.check(&sample(1, 7), at(7));
        assert!(restarted.fresh && restarted.health == Health::GOOD);
        let nan = Sample { pose: Pose::new(DVec3::NAN, DQuat::IDENTITY), ..sample(2, 8) };
        let got = check.check(&nan, at(8));
        assert!(got.health == Health::INVALID && got.sample.unwrap().sequence == 1);
        let long = Sample { pose: Pose::new(DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 1.1)), ..sample(2, 8) };
        assert_eq!(check.check(&long, at(8)).health, Health::INVALID);
        let gone = Sample { connected: false, ..sample(3, 9) };
        assert_eq!(check.check(&gone, at(9)).health, Health::DISCONNECTED);
    }

    #[test]
    fn one_measurement_under_two_numbers_is_a_duplicate() {
        let mut check = SampleCheck::new(0.01);
        check.check(&sample(1, 1), at(1));
        let twice = check.check(&sample(2, 1), at(2));
        assert!(twice.health == Health::SEQUENCE && !twice.fresh);
        // Another pose at the same moment is news, however coarse the device's clock.
        let moved = Sample { pose: Pose::new(DVec3::X, DQuat::IDENTITY), ..sample(3, 1) };
        let news = check.check(&moved, at(3));
        assert!(news.health == Health::GOOD && news.fresh);
    }

    #[test]
    fn a_button_pressed_between_two_poses_is_no_fault() {
        let mut check = SampleCheck::new(0.01);
        check.check(&sample(1, 1), at(1));
        let pressed = check.check(&Sample { buttons: 2, ..sample(1, 1) }, at(2));
        assert!(pressed.health == Health::GOOD && !pressed.fresh);
        assert_eq!(pressed.sample.unwrap().buttons, 2);
    }

    #[test]
    fn extreme_stamps_do_not_overflow() {
        let mut check = SampleCheck::new(0.01);
        check.check(&Sample { stamp: Stamp(i64::MIN), ..sample(1, 0) }, Stamp(i64::MAX));
        assert!(
            check.check(&Sample { stamp: Stamp(i64::MAX), ..sample(2, 0) }, Stamp(i64::MIN)).health.any(Health::STALE)
        );
    }
}
