use spatial::Stamp;

/// Says yes once in each period of robot time.
#[derive(Clone, Copy, Debug)]
pub struct Due {
    period_ns: i64,
    next: Option<Stamp>,
}

impl Due {
    /// Once in so many seconds.
    #[must_use]
    pub fn every(seconds: f64) -> Self {
        Self { period_ns: (seconds * 1e9).max(1.0) as i64, next: None }
    }

    /// Whether it is time; a clock that went back, or ahead by more than a period, begins a new grid.
    pub fn at(&mut self, now: Stamp) -> bool {
        let next = self.next.unwrap_or(now);
        if now < next && next.0 - now.0 <= self.period_ns {
            return false;
        }
        let on_grid = next.0 + self.period_ns;
        let fresh = now.0 + self.period_ns;
        self.next = Some(Stamp(if on_grid > now.0 && on_grid <= fresh { on_grid } else { fresh }));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn due_keeps_its_rate_on_a_grid_that_does_not_divide_it() {
        let mut due = Due::every(1.0 / 300.0);
        let said = (0..3000).filter(|ms| due.at(Stamp(ms * 1_000_000))).count();
        assert!((899..=901).contains(&said), "{said} in 3 s at 300 Hz");
    }

    #[test]
    fn due_survives_a_clock_that_steps() {
        let mut due = Due::every(0.01);
        assert!(due.at(Stamp(5_000_000_000)));
        assert!(due.at(Stamp(1_000_000_000)), "back");
        assert!(!due.at(Stamp(1_001_000_000)));
        assert!(due.at(Stamp(9_000_000_000)), "ahead");
        assert!(!due.at(Stamp(9_000_000_001)));
    }
}
