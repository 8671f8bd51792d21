//! How far a part has gone: what was found at one pose holds until that has used up a slack.

use spatial::{DQuat, DVec3};

/// The distance between unit quaternions, twice the sine of a quarter of the angle, times this is the angle or more, up to 1.5 radians.
const CHORD: f64 = 2.1;

/// The way of the part in the hand, counted from pose to pose.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    /// Farthest point of the part from its origin, metres.
    pub lever: f64,
    gone: Gone,
    last: (DVec3, DQuat),
}

/// How far at most; of a slack, how far at least until something may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gone {
    /// Of any point of the part, metres.
    pub way: f64,
    /// Of any direction, radians.
    pub turn: f64,
}

impl Gone {
    pub const NEVER: Self = Self { way: f64::NEG_INFINITY, turn: f64::NEG_INFINITY };

    /// When a slack from here on is used up.
    pub fn after(self, slack: Self) -> Self {
        Self { way: self.way + slack.way, turn: self.turn + slack.turn }
    }

    #[inline]
    pub fn is_before(self, until: Self) -> bool {
        self.way < until.way && self.turn < until.turn
    }
}

impl Way {
    pub fn new(lever: f64) -> Self {
        Self { lever, gone: Gone { way: 0.0, turn: 0.0 }, last: (DVec3::ZERO, DQuat::IDENTITY) }
    }

    /// Goes on to a pose.
    #[inline]
    pub fn go(&mut self, translation: DVec3, rotation: DQuat) -> Gone {
        let chord = CHORD * (rotation - self.last.1).length();
        // A turn so large may be more: nothing that was found shall hold.
        let turn = if chord < 1.5 { chord } else { 10.0 };
        self.gone.turn += turn;
        self.gone.way += (translation - self.last.0).length() + self.lever * turn;
        self.last = (translation, rotation);
        self.gone
    }
}
