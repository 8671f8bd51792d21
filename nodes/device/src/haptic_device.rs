use serde::{Deserialize, Serialize};
use spatial::{Pose, Stamp, Twist, Wrench};

/// One reading of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Counts samples from the device, from 1; 0 means that none has come yet.
    pub sequence: u64,
    /// When the device measured it.
    pub stamp: Stamp,
    /// Pose of the device's handle in the device's base frame.
    pub pose: Pose,
    /// Velocity of the handle, axes of the base frame; zero if `has_twist` is false.
    pub twist: Twist,
    /// Whether the device measures velocity; else the servo differentiates.
    pub has_twist: bool,
    /// Button mask, bit 0 the first button.
    pub buttons: u32,
    /// False while the device is unplugged or its last report was garbage.
    pub connected: bool,
}

/// What a device can do. Commands from elsewhere are shortened to it ([`DeviceSpec::shown`]); the loop itself is limited by
/// its gains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeviceSpec {
    /// Name for messages.
    pub name: String,
    /// Half extents of the workspace, metres.
    pub workspace: spatial::DVec3,
    /// Greatest force it can show, N; 0 for an input-only device.
    pub max_force: f64,
    /// Greatest torque it can show, N.m; 0 for none.
    pub max_torque: f64,
    /// Greatest stiffness that its maker states, N/m.
    pub max_stiffness: f64,
    /// Position resolution, metres.
    pub resolution: f64,
    /// Moving mass felt at the handle, kg.
    pub mass: f64,
    /// Damping of its mechanics, N.s/m.
    pub damping: f64,
}

impl DeviceSpec {
    /// A desktop force-feedback arm of the usual size, where nothing better is known.
    #[must_use]
    pub fn force_feedback(name: &str) -> Self {
        Self {
            name: name.into(),
            workspace: spatial::DVec3::splat(0.2),
            max_force: 20.0,
            max_torque: 1.0,
            max_stiffness: 3000.0,
            resolution: 1e-5,
            mass: 0.1,
            damping: 1.0,
        }
    }

    /// What the device can show of a finite wrench: force and torque keep their directions and are shortened to its
    /// greatest.
    #[must_use]
    pub fn shown(&self, wrench: &Wrench) -> Wrench {
        Wrench::new(wrench.force.clamp_length_max(self.max_force), wrench.torque.clamp_length_max(self.max_torque))
    }
}

/// A device as the servo thread sees it. Neither call blocks, allocates or locks: drivers that must, keep a thread of
/// their own and speak through latest-value cells.
pub trait HapticDevice: Send {
    /// What the device can do.
    fn spec(&self) -> &DeviceSpec;
    /// The newest sample at time `now`; the same again if there is no newer one.
    fn read(&mut self, now: Stamp) -> Sample;
    /// Shows a wrench on the hand: axes of the base frame, torque about the handle's origin.
    fn write(&mut self, wrench: &Wrench);
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::DVec3;

    #[test]
    fn a_device_shows_no_more_than_it_can() {
        let spec = DeviceSpec::force_feedback("arm");
        let small = Wrench::new(DVec3::new(3.0, -4.0, 0.0), DVec3::X * 0.5);
        assert_eq!(spec.shown(&small), small);
        for much in [1e2, 1e6, 1e150] {
            let shown = spec.shown(&Wrench::new(DVec3::X * -much, DVec3::Y * much));
            assert_eq!(shown, Wrench::new(DVec3::X * -20.0, DVec3::Y));
        }
        let input_only = DeviceSpec { max_force: 0.0, max_torque: 0.0, ..spec };
        assert_eq!(input_only.shown(&small), Wrench::ZERO);
    }
}
