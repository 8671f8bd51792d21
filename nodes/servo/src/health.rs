use serde::{Deserialize, Serialize};

/// Health bits of a tick; no bit set is good health.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Health(pub u32);

macro_rules! bits {
    ($($(#[$doc:meta])* $name:ident = $bit:expr, $label:literal;)*) => {
        impl Health {
            $($(#[$doc])* pub const $name: Self = Self(1 << $bit);)*

            /// Every bit with its short name, lowest first.
            pub const NAMES: &'static [(Self, &'static str)] = &[$((Self::$name, $label)),*];
        }
    };
}

bits! {
    /// The newest sample is older than `device.timeout`: force is zero.
    STALE = 0, "stale";
    /// The sample had NaN, infinity or a quaternion that is not of unit length: force is zero.
    INVALID = 1, "invalid";
    /// The pose jumped (dropped samples, teleport): re-seeded, force ramps from zero.
    JUMP = 2, "jump";
    /// Force or torque reached its limit.
    SATURATED = 3, "saturated";
    /// The passivity controller could not dissipate the energy in its budget: force is reduced.
    ENERGY = 4, "energy";
    /// The device is unplugged or its reports are garbage: force is zero.
    DISCONNECTED = 5, "disconnected";
    /// The tick came late by more than a period.
    LATE = 6, "late";
    /// A ring was full: records were lost on the way to ROS or to the pictures.
    RING_FULL = 7, "ring full";
    /// A sample was a duplicate or came out of order.
    SEQUENCE = 8, "sequence";
    /// The tracked depth is not the global minimum.
    DIVERGENT = 9, "divergent";
    /// The tracker was seeded anew.
    RESEEDED = 10, "reseeded";
    /// More basic contacts than a record carries, or an iteration bound was reached.
    OVERFLOW = 11, "overflow";
    /// The law's numbers were not finite: force is zero.
    FAULT = 12, "fault";
    /// The device shows no force (input only).
    INPUT_ONLY = 13, "input only";
    /// The dead-man switch is released.
    DEADMAN = 14, "dead man";
    /// The wall clock stepped against the monotonic one.
    CLOCK_STEP = 15, "clock step";
}

impl Health {
    /// No trouble.
    pub const GOOD: Self = Self(0);
    /// Bits on which the force is zero at once.
    pub const ZERO_FORCE: Self =
        Self(Self::STALE.0 | Self::INVALID.0 | Self::DISCONNECTED.0 | Self::FAULT.0 | Self::DEADMAN.0);

    /// Whether any of `other`'s bits is set.
    #[must_use]
    pub const fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Sets `other`'s bits.
    pub fn set(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl std::ops::BitOr for Health {
    type Output = Self;
    fn bitor(self, o: Self) -> Self {
        Self(self.0 | o.0)
    }
}

impl std::fmt::Display for Health {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut first = true;
        for (bit, name) in Self::NAMES {
            if self.any(*bit) {
                write!(f, "{}{name}", if first { "" } else { "|" })?;
                first = false;
            }
        }
        if first { f.write_str("good") } else { Ok(()) }
    }
}
