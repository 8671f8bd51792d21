use spatial::Stamp;

/// Poses in a row that tell that it is the clocks.
const ROW: u32 = 50;

/// Looks whether poses whose stamps are trusted are stale as they arrive: where the driver's clock is behind this machine's
/// they are so for ever, and the force stays off though the driver speaks.
#[derive(Clone, Copy, Debug, Default)]
pub struct StampWatch {
    row: u32,
}

impl StampWatch {
    /// A pose stamped `stamp` (0: not at all) came at `now`; samples are stale from the age `timeout` on, s. What to tell,
    /// once for each time that it begins.
    pub fn see(&mut self, stamp: Stamp, now: Stamp, timeout: f64) -> Option<String> {
        let age = now.0.saturating_sub(stamp.0) as f64 * 1e-9;
        if stamp == Stamp(0) || age <= timeout {
            self.row = 0;
            return None;
        }
        self.row = self.row.saturating_add(1);
        (self.row == ROW).then(|| {
            format!(
                "device.trust_stamps: poses are {age:.3} s old by this machine's clock when they come, device.timeout is {timeout} s: \
                 no force; set the driver's clock by this machine's (chrony, PTP) or device.trust_stamps to false"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_is_behind_is_told_once_until_it_is_right() {
        let mut watch = StampWatch::default();
        let mut told = |poses: i64, behind_ms: i64| {
            let said = (0..poses).filter_map(|i| {
                let now = 1_000_000_000_000 + i * 1_000_000;
                watch.see(Stamp(now - behind_ms * 1_000_000), Stamp(now), 0.01)
            });
            said.collect::<Vec<_>>()
        };
        assert!(told(1000, 2).is_empty());
        assert!(told(1000, -5000).is_empty(), "ahead: counts as just arrived");
        assert!(told(49, 3200).is_empty(), "late poses among others");
        assert!(told(1, 2).is_empty());
        let said = told(1000, 3200);
        assert!(said.len() == 1 && said[0].contains("3.200 s old") && said[0].contains("0.01 s"), "{said:?}");
        assert!(told(10, 2).is_empty());
        assert_eq!(told(1000, 3200).len(), 1);
        assert!(watch.see(Stamp(0), Stamp(1_000_000_000_000), 0.01).is_none(), "a driver that does not stamp");
    }
}
