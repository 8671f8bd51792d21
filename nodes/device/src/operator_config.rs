use serde::{Deserialize, Serialize};

/// The simulated operator's arm, tremor and errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OperatorConfig {
    /// Seed of tremor and errors: the same seed, wrenches and times give the same motion, bit for bit.
    pub seed: u64,
    /// Mass of hand and handle, kg.
    pub mass: f64,
    /// Damping of the arm, N.s/m.
    pub damping: f64,
    /// Stiffness of the arm about the intended pose, N/m.
    pub stiffness: f64,
    /// Moment of inertia of hand and handle, kg.m^2.
    pub inertia: f64,
    /// Rotational damping of wrist and grip, N.m.s/rad.
    pub rotation_damping: f64,
    /// Rotational stiffness of wrist and grip, N.m/rad.
    pub rotation_stiffness: f64,
    /// Amplitude of the tremor's force, N (8 to 12 Hz).
    pub tremor_force: f64,
    /// Amplitude of the tremor's torque, N.m.
    pub tremor_torque: f64,
    /// By how much the hand holds the part askew, rad: about another axis each time the plan starts over.
    pub misalignment: f64,
    /// How far the hand aims beside the mark, metres: in another direction each time.
    pub aim_error: f64,
    /// Speed of the plan, 1 as planned.
    pub speed: f64,
}

impl Default for OperatorConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            mass: 1.0,
            damping: 10.0,
            stiffness: 200.0,
            inertia: 1e-3,
            rotation_damping: 0.02,
            rotation_stiffness: 0.3,
            tremor_force: 0.1,
            tremor_torque: 2e-3,
            misalignment: 2f64.to_radians(),
            aim_error: 3e-4,
            speed: 1.0,
        }
    }
}

/// Why a simulated operator cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OperatorError {
    /// A number out of its range.
    #[error("simulated operator: {name} = {value} must be {range}")]
    Range {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// A plan without waypoints, or with a pose or a time that is no number.
    #[error("simulated operator: {0}")]
    Plan(String),
}

impl OperatorConfig {
    /// Checks every number; NaN fails.
    ///
    /// # Errors
    /// Names the first parameter out of range.
    pub fn check(&self) -> Result<(), OperatorError> {
        // The arm is integrated in steps of 0.1 ms: these bounds keep it well inside what that can follow.
        let bounds = [
            ("mass", self.mass, 0.05, 20.0, "0.05 to 20 kg"),
            ("damping", self.damping, 0.0, 200.0, "0 to 200 N.s/m"),
            ("stiffness", self.stiffness, 1.0, 5000.0, "1 to 5000 N/m"),
            ("inertia", self.inertia, 1e-4, 1.0, "1e-4 to 1 kg.m^2"),
            ("rotation_damping", self.rotation_damping, 0.0, 0.5, "0 to 0.5 N.m.s/rad"),
            ("rotation_stiffness", self.rotation_stiffness, 1e-3, 20.0, "1e-3 to 20 N.m/rad"),
            ("tremor_force", self.tremor_force, 0.0, 5.0, "0 to 5 N"),
            ("tremor_torque", self.tremor_torque, 0.0, 0.2, "0 to 0.2 N.m"),
            ("misalignment", self.misalignment, 0.0, 0.5, "0 to 0.5 rad"),
            ("aim_error", self.aim_error, 0.0, 0.05, "0 to 0.05 m"),
            ("speed", self.speed, 0.05, 20.0, "0.05 to 20"),
        ];
        for (name, value, low, high, range) in bounds {
            if !(value >= low && value <= high) {
                return Err(OperatorError::Range { name, value, range });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_and_negative_numbers_are_refused_by_name() {
        assert_eq!(OperatorConfig::default().check(), Ok(()));
        let bad = [
            (OperatorConfig { mass: f64::NAN, ..Default::default() }, "mass"),
            (OperatorConfig { stiffness: -1.0, ..Default::default() }, "stiffness"),
            (OperatorConfig { speed: 0.0, ..Default::default() }, "speed"),
            (OperatorConfig { tremor_force: f64::INFINITY, ..Default::default() }, "tremor_force"),
        ];
        for (config, name) in bad {
            let error = config.check().unwrap_err();
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}
