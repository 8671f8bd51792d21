use device::DeviceSpec;
use haptics::Gains;

/// What a device can show at most: a limit beyond it would let the energy account count forces that the hand never feels.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceLimits {
    name: String,
    /// N.
    force: f64,
    /// N.m.
    torque: f64,
}

impl DeviceLimits {
    /// Of a device in this process. One that shows no force at all limits nothing: its force is for the eye.
    #[must_use]
    pub fn of(spec: &DeviceSpec) -> Self {
        let or_none = |most: f64| if most > 0.0 { most } else { f64::INFINITY };
        Self { name: spec.name.clone(), force: or_none(spec.max_force), torque: or_none(spec.max_torque) }
    }

    /// Of a driver behind topics, which does not say what it can.
    #[must_use]
    pub fn unknown() -> Self {
        Self { name: String::new(), force: f64::INFINITY, torque: f64::INFINITY }
    }

    /// The gains, with limits that the device can show.
    #[must_use]
    pub fn hold(&self, gains: Gains) -> Gains {
        Gains { max_force: gains.max_force.min(self.force), max_torque: gains.max_torque.min(self.torque), ..gains }
    }

    /// What is asked for beyond it, in one line.
    #[must_use]
    pub fn finding(&self, gains: &Gains) -> Option<String> {
        let over = |name: &str, asked: f64, most: f64, unit: &str| {
            (asked > most).then(|| format!("limits.{name} {asked} {unit} is held to {most} {unit}"))
        };
        let force = over("max_force", gains.max_force, self.force, "N");
        let torque = over("max_torque", gains.max_torque, self.torque, "N.m");
        let both: Vec<String> = force.into_iter().chain(torque).collect();
        (!both.is_empty()).then(|| format!("{}: all that device `{}` can show", both.join(", "), self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_device_cannot_show_is_not_asked_of_it() {
        let limits = DeviceLimits::of(&DeviceSpec { max_force: 5.0, ..DeviceSpec::force_feedback("arm") });
        let gains = Gains { max_force: 10.0, max_torque: 0.5, ..Gains::default() };
        assert_eq!(limits.hold(gains), Gains { max_force: 5.0, ..gains });
        let said = limits.finding(&gains).unwrap();
        assert_eq!(said, "limits.max_force 10 N is held to 5 N: all that device `arm` can show");
        assert_eq!(limits.finding(&limits.hold(gains)), None);
    }

    #[test]
    fn a_device_without_motors_and_one_behind_topics_limit_nothing() {
        let eye = DeviceSpec { max_force: 0.0, max_torque: 0.0, ..DeviceSpec::force_feedback("mouse") };
        let gains = Gains { max_force: 1e4, max_torque: 1e3, ..Gains::default() };
        for limits in [DeviceLimits::of(&eye), DeviceLimits::unknown()] {
            assert_eq!((limits.hold(gains), limits.finding(&gains)), (gains, None));
        }
    }
}
