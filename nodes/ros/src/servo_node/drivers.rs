use super::pose_file::read_pose_file;
use super::{DeviceWatch, TopicLink};
use crate::{Failure, Outcome};
use device::{HapticDevice, Replay, SimulatedOperator, SpaceMouse, SpaceMouseConfig, TopicConfig};
use r2r::Node;
use scene::Scene;
use servo::config::{Config, Driver};
use servo::operator_plan;

/// Opens a device that lives in this process. One that may be plugged in later need not be there.
///
/// # Errors
/// It cannot be had, its settings make no sense, or it lives behind topics.
pub fn open_local(config: &Config, scene: &Scene) -> Outcome<(Box<dyn HapticDevice>, DeviceWatch)> {
    let refuse = |e: &dyn std::fmt::Display| Failure::new(e.to_string());
    let d = &config.device;
    let mut watch = DeviceWatch::default();
    let device: Box<dyn HapticDevice> = match d.driver {
        Driver::Simulated => {
            let plan = operator_plan(&scene.world)
                .ok_or_else(|| Failure::new(format!("scene {} has no part or no obstacle", scene.name)))?;
            Box::new(SimulatedOperator::new(d.operator, plan).map_err(|e| refuse(&e))?)
        }
        Driver::Replay => Box::new(Replay::new(&read_pose_file(&d.file)?).map_err(|e| refuse(&e))?),
        Driver::SpaceMouse => {
            let settings =
                SpaceMouseConfig { speed: d.speed, angular_speed: d.turn_speed, ..SpaceMouseConfig::default() };
            let mouse = SpaceMouse::start(settings).map_err(|e| refuse(&e))?;
            watch = DeviceWatch::of(mouse.monitor());
            Box::new(mouse)
        }
        Driver::Topic => return Err(Failure::new("device.driver: `topic` is for haptic_servo; choose another driver")),
    };
    Ok((device, watch))
}

/// The device of a servo.
pub struct Opened {
    /// The device.
    pub device: Box<dyn HapticDevice>,
    /// Its topics, if it lives behind some.
    pub link: Option<TopicLink>,
    /// Whether it comes and goes.
    pub watch: DeviceWatch,
}

/// Opens the device that the configuration names, here or behind topics.
///
/// # Errors
/// See [`open_local`].
pub fn open(node: &mut Node, config: &Config, scene: &Scene, trust_stamps: bool) -> Outcome<Opened> {
    if config.device.driver == Driver::Topic {
        let (device, link) = TopicLink::open(node, TopicConfig { trust_stamps }, config.device.timeout)?;
        return Ok(Opened { device: Box::new(device), link: Some(link), watch: DeviceWatch::default() });
    }
    let (device, watch) = open_local(config, scene)?;
    Ok(Opened { device, link: None, watch })
}
