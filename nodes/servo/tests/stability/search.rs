//! The largest stable value of a gain.

/// Steps upwards, until one fails.
const CLIMB: f64 = 1.3;
/// How near the limit is found.
const CLOSE: f64 = 1.02;

/// The largest value, within 2 %, up to which `is_stable` holds all the way from `low`, seen at steps of 30 %; `high` if it
/// holds up to there, and zero if not even at `low`.
pub fn largest(low: f64, high: f64, mut is_stable: impl FnMut(f64) -> bool) -> f64 {
    if !is_stable(low) {
        return 0.0;
    }
    let mut good = low;
    let mut bad = loop {
        if good >= high {
            return high;
        }
        let next = (good * CLIMB).min(high);
        if !is_stable(next) {
            break next;
        }
        good = next;
    };
    while bad / good > CLOSE {
        let middle = (good * bad).sqrt();
        if is_stable(middle) { good = middle } else { bad = middle }
    }
    good
}
