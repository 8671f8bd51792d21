use serde::{Deserialize, Serialize};

/// A moment on the robot's clock (ROS time), nanoseconds since its epoch. Never read inside the tick: handed in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Stamp(pub i64);

impl Stamp {
    /// From seconds; rounds to the nearest nanosecond.
    #[must_use]
    pub fn from_secs_f64(t: f64) -> Self {
        Self((t * 1e9).round() as i64)
    }

    /// Seconds since the epoch.
    #[must_use]
    pub fn as_secs_f64(self) -> f64 {
        self.0 as f64 * 1e-9
    }

    /// Whole seconds and the rest in nanoseconds, as `builtin_interfaces/Time` wants them.
    #[must_use]
    pub fn sec_nanosec(self) -> (i32, u32) {
        (self.0.div_euclid(1_000_000_000) as i32, self.0.rem_euclid(1_000_000_000) as u32)
    }

    /// The reverse of [`Stamp::sec_nanosec`].
    #[must_use]
    pub fn from_sec_nanosec(sec: i32, nanosec: u32) -> Self {
        Self(i64::from(sec) * 1_000_000_000 + i64::from(nanosec))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_negative_times_downwards() {
        let t = Stamp(-1);
        assert_eq!(t.sec_nanosec(), (-1, 999_999_999));
        assert_eq!(Stamp::from_sec_nanosec(-1, 999_999_999), t);
    }
}
