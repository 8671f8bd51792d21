use haptics::Gains;
use spatial::Wrench;

/// What the world asks of the loop: one latest-value cell carries it whole, and each tick reads it once at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commands {
    /// Whether force is wanted (`~/enable`).
    pub enabled: bool,
    /// Counts `~/reset` calls; a change re-seeds.
    pub reset_count: u32,
    /// Gains, checked by whoever writes them.
    pub gains: Gains,
    /// Wrench measured at the robot, N and N.m; zero if none.
    pub remote: Wrench,
}

impl Default for Commands {
    /// Force off, gains as they come.
    fn default() -> Self {
        Self { enabled: false, reset_count: 0, gains: Gains::default(), remote: Wrench::ZERO }
    }
}
