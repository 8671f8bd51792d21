use serde::{Deserialize, Serialize};

/// What a deflection of the cap means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SpaceMouseMode {
    /// Velocity: the pose stays where it is when the cap is let go.
    #[default]
    Rate,
    /// Position: the pose springs back with the cap.
    Position,
}

/// How the cap moves the pose.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpaceMouseConfig {
    /// What a deflection means.
    pub mode: SpaceMouseMode,
    /// Deflection that counts as none, as a part of full scale.
    pub dead_band: f64,
    /// Speed at full deflection, m/s (mode `rate`).
    pub speed: f64,
    /// Angular speed at full deflection, rad/s (mode `rate`).
    pub angular_speed: f64,
    /// Half extent of the workspace, metres: where `rate` stops, and full deflection in mode `position`.
    pub reach: f64,
    /// Turn at full deflection, rad (mode `position`).
    pub angle: f64,
    /// Time constant that smooths the steps between reports (every 8 to 16 ms), s; 0 for none.
    pub smoothing: f64,
    /// Whether the device's light shows that the driver holds it.
    pub led: bool,
}

impl Default for SpaceMouseConfig {
    fn default() -> Self {
        Self {
            mode: SpaceMouseMode::Rate,
            dead_band: 0.04,
            speed: 0.1,
            angular_speed: 1.0,
            reach: 0.1,
            angle: 0.8,
            smoothing: 0.02,
            led: true,
        }
    }
}

/// Why a SpaceMouse driver cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum SpaceMouseError {
    /// A number out of its range.
    #[error("spacemouse: {name} = {value} must be {range}")]
    Range {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// The system gave no thread.
    #[error("spacemouse: cannot start its thread: {0}")]
    Thread(#[from] std::io::Error),
}

impl SpaceMouseConfig {
    /// Checks every number; NaN fails.
    ///
    /// # Errors
    /// Names the first parameter out of range.
    pub fn check(&self) -> Result<(), SpaceMouseError> {
        let bounds = [
            ("dead_band", self.dead_band, 0.0, 0.9, "0 to 0.9"),
            ("speed", self.speed, 0.0, 2.0, "0 to 2 m/s"),
            ("angular_speed", self.angular_speed, 0.0, 10.0, "0 to 10 rad/s"),
            ("reach", self.reach, 1e-3, 2.0, "1e-3 to 2 m"),
            ("angle", self.angle, 0.0, 3.0, "0 to 3 rad"),
            ("smoothing", self.smoothing, 0.0, 1.0, "0 to 1 s"),
        ];
        for (name, value, low, high, range) in bounds {
            if !(value >= low && value <= high) {
                return Err(SpaceMouseError::Range { name, value, range });
            }
        }
        Ok(())
    }
}
