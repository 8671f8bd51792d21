use crate::config::MappingConfig;
use device::{DeviceSpec, HapticDevice, Sample};
use spatial::{Pose, Stamp, Wrench};

/// A device whose base frame stands somewhere in W: samples come out in W, wrenches go in in axes of W.
pub struct AlignedDevice {
    inner: Box<dyn HapticDevice>,
    world_from_base: Pose,
}

impl AlignedDevice {
    /// Places a device as `mapping.x` to `mapping.yaw` say.
    #[must_use]
    pub fn new(inner: Box<dyn HapticDevice>, config: &MappingConfig) -> Self {
        Self { inner, world_from_base: Pose::from_xyz_rpy(config.xyz, config.rpy) }
    }
}

impl HapticDevice for AlignedDevice {
    fn spec(&self) -> &DeviceSpec {
        self.inner.spec()
    }

    fn read(&mut self, now: Stamp) -> Sample {
        let mut sample = self.inner.read(now);
        if self.world_from_base != Pose::IDENTITY {
            sample.pose = self.world_from_base * sample.pose;
            sample.twist.linear = self.world_from_base.transform_vector(sample.twist.linear);
            sample.twist.angular = self.world_from_base.transform_vector(sample.twist.angular);
        }
        sample
    }

    fn write(&mut self, wrench: &Wrench) {
        let base_from_world = self.world_from_base.inverse();
        self.inner.write(&Wrench {
            force: base_from_world.transform_vector(wrench.force),
            torque: base_from_world.transform_vector(wrench.torque),
        });
    }
}
