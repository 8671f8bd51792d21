use crate::{DeviceSpec, HapticDevice, Sample};
use spatial::{Pose, Stamp, Wrench};

/// Recorded poses at their recorded times, counted from the first read. Between two of them the earlier one holds, as
/// it did when they were recorded; after the last one samples grow old, and force goes.
#[derive(Debug)]
pub struct Replay {
    spec: DeviceSpec,
    /// Nanoseconds after the first pose, rising.
    poses: Vec<(i64, Pose)>,
    start: Option<Stamp>,
    current: usize,
}

/// Why poses cannot be replayed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReplayError {
    /// There are none.
    #[error("replay: no poses")]
    Empty,
    /// A pose or a time is not finite, or a quaternion is not of unit length.
    #[error("replay: pose {0} (from 0) is not valid")]
    Invalid(usize),
    /// Time does not rise.
    #[error("replay: the time of pose {0} (from 0) is not after the one before")]
    Order(usize),
}

impl Replay {
    /// From times in seconds and poses of the handle in the base frame.
    ///
    /// # Errors
    /// Names the first pose that is not valid or not later than the one before.
    pub fn new(poses: &[(f64, Pose)]) -> Result<Self, ReplayError> {
        let Some((first, _)) = poses.first() else { return Err(ReplayError::Empty) };
        let mut timed: Vec<(i64, Pose)> = Vec::with_capacity(poses.len());
        for (n, (t, pose)) in poses.iter().enumerate() {
            if !t.is_finite() || !pose.is_valid() {
                return Err(ReplayError::Invalid(n));
            }
            let after = Stamp::from_secs_f64(t - first).0;
            if timed.last().is_some_and(|(before, _)| after <= *before) {
                return Err(ReplayError::Order(n));
            }
            timed.push((after, *pose));
        }
        Ok(Self { spec: DeviceSpec::force_feedback("replay"), poses: timed, start: None, current: 0 })
    }

    /// Whether the last pose has been reached.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.current + 1 == self.poses.len()
    }
}

impl HapticDevice for Replay {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read(&mut self, now: Stamp) -> Sample {
        let start = *self.start.get_or_insert(now);
        let elapsed = now.0.saturating_sub(start.0);
        while self.poses.get(self.current + 1).is_some_and(|(t, _)| *t <= elapsed) {
            self.current += 1;
        }
        let (at, pose) = self.poses[self.current];
        let last = self.is_finished();
        Sample {
            sequence: self.current as u64 + 1,
            stamp: if last { Stamp(start.0 + at) } else { now },
            pose,
            connected: true,
            ..Sample::default()
        }
    }

    /// Nobody feels it.
    fn write(&mut self, _wrench: &Wrench) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DVec3;

    fn at(x: f64) -> Pose {
        Pose::new(DVec3::X * x, Pose::IDENTITY.rotation)
    }

    #[test]
    fn holds_each_pose_from_its_time_and_ages_after_the_last() {
        let mut replay = Replay::new(&[(5.0, at(0.0)), (5.010, at(1.0)), (5.020, at(2.0))]).unwrap();
        let t0 = 1_000_000_000;
        let xs: Vec<f64> = (0..4).map(|n| replay.read(Stamp(t0 + n * 7_000_000)).pose.translation.x).collect();
        assert_eq!(xs, [0.0, 0.0, 1.0, 2.0]);
        let late = replay.read(Stamp(t0 + 500_000_000));
        assert_eq!((late.stamp, late.sequence), (Stamp(t0 + 20_000_000), 3));
        assert!(replay.is_finished());
    }

    #[test]
    fn bad_recordings_are_refused_by_number() {
        assert_eq!(Replay::new(&[]).unwrap_err(), ReplayError::Empty);
        assert_eq!(Replay::new(&[(0.0, at(0.0)), (f64::NAN, at(0.0))]).unwrap_err(), ReplayError::Invalid(1));
        assert_eq!(Replay::new(&[(0.0, at(f64::INFINITY))]).unwrap_err(), ReplayError::Invalid(0));
        assert_eq!(Replay::new(&[(1.0, at(0.0)), (1.0, at(1.0))]).unwrap_err(), ReplayError::Order(1));
    }
}
