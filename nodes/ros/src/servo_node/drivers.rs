use super::TopicLink;
use super::pose_file::read_pose_file;
use crate::{Failure, Outcome};
use device::{HapticDevice, Replay, SimulatedOperator, SpaceMouse, SpaceMouseConfig, TopicConfig};
use r2r::Node;
use scene::Scene;
use servo::config::{Config, Driver};
use servo::operator_plan;

/// Opens a device that lives in this process.
///
/// # Errors
/// It is not there, its settings make no sense, or it lives behind topics.
pub fn open_local(config: &Config, scene: &Scene) -> Outcome<Box<dyn HapticDevice>> {
    let refuse = |e: &dyn std::fmt::Display| Failure::new(e.to_string());
    let d = &config.device;
    Ok(match d.driver {
        Driver::Simulated => {
            let plan = operator_plan(&scene.world)
                .ok_or_else(|| Failure::new(format!("scene {} has no part or no obstacle", scene.name)))?;
            Box::new(SimulatedOperator::new(d.operator, plan).map_err(|e| refuse(&e))?)
        }
        Driver::Replay => Box::new(Replay::new(&read_pose_file(&d.file)?).map_err(|e| refuse(&e))?),
        Driver::SpaceMouse => {
            let settings =
                SpaceMouseConfig { speed: d.speed, angular_speed: d.turn_speed, ..SpaceMouseConfig::default() };
            Box::new(SpaceMouse::start(settings).map_err(|e| refuse(&e))?)
        }
        Driver::Topic => return Err(Failure::new("device.driver: `topic` is for haptic_servo; choose another driver")),
    })
}

/// Opens the device that the configuration names, here or behind topics.
///
/// # Errors
/// See [`open_local`].
pub fn open(
    node: &mut Node,
    config: &Config,
    scene: &Scene,
    trust_stamps: bool,
) -> Outcome<(Box<dyn HapticDevice>, Option<TopicLink>)> {
    if config.device.driver == Driver::Topic {
        let (device, link) = TopicLink::open(node, TopicConfig { trust_stamps }, config.device.timeout)?;
        return Ok((Box::new(device), Some(link)));
    }
    Ok((open_local(config, scene)?, None))
}
