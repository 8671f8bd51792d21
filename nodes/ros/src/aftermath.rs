use crate::Outcome;
use std::time::{Duration, Instant};

/// What comes after a pause this long, and after so many looks, is not waited for.
const QUIET: (Duration, u32) = (Duration::from_millis(150), 10);
/// And where others go on speaking, nobody waits longer than this.
const MOST: Duration = Duration::from_secs(2);

/// For a listener that was told to end: takes what is still on its way. `turn` takes what has come, or waits a little, and
/// says whether anything came; it is called until nothing has come for a while.
///
/// # Errors
/// The first of `turn`.
pub fn take_what_is_left(mut turn: impl FnMut() -> Outcome<bool>) -> Outcome<()> {
    let begun = Instant::now();
    let (mut last, mut looks) = (begun, 0);
    // Time alone tells nothing: while the process stood still, the messages did not.
    while begun.elapsed() < MOST && (last.elapsed() < QUIET.0 || looks < QUIET.1) {
        looks += 1;
        if turn()? {
            (last, looks) = (Instant::now(), 0);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_is_taken_though_the_process_stood_still() {
        let (mut turns, mut taken) = (0, 0);
        take_what_is_left(|| {
            turns += 1;
            std::thread::sleep(if turns == 1 { QUIET.0 * 2 } else { QUIET.0 / QUIET.1 });
            let came = (2..5).contains(&turns);
            taken += u32::from(came);
            Ok(came)
        })
        .unwrap();
        assert_eq!(taken, 3);
    }
}
