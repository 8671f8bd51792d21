use crate::config::MappingConfig;
use device::Sample;
use spatial::{DQuat, DVec3, Pose};

/// From the hand's pose to the part's: scale, clutch and dead-man switch.
///
/// `p_a = offset + scale p_hand`, `R_a = R_hand twist`: the hand turns the part about the world's axes, whatever the clutch
/// did before, so that the torque on the part is the torque on the hand.
#[derive(Clone, Copy, Debug)]
pub struct Mapping {
    scale: f64,
    clutch: u32,
    deadman: u32,
    offset: DVec3,
    twist: DQuat,
    clutched: bool,
    world_from_a: Pose,
}

impl Mapping {
    /// The mapping of a configuration, offset zero.
    #[must_use]
    pub fn new(config: &MappingConfig) -> Self {
        let bit = |button: i64| u32::try_from(button).ok().and_then(|b| 1u32.checked_shl(b)).unwrap_or(0);
        Self {
            scale: config.scale,
            clutch: bit(config.clutch_button),
            deadman: bit(config.deadman_button),
            offset: DVec3::ZERO,
            twist: DQuat::IDENTITY,
            clutched: false,
            world_from_a: Pose::IDENTITY,
        }
    }

    /// The part's pose for a sample; while the clutch is held it stays where it was.
    pub fn map(&mut self, sample: &Sample) -> Pose {
        let hand = &sample.pose;
        let clutched = sample.buttons & self.clutch != 0;
        if self.clutched && !clutched {
            // Taken up again from here: the part must not move.
            self.offset = self.world_from_a.translation - hand.translation * self.scale;
            self.twist = (hand.rotation.conjugate() * self.world_from_a.rotation).normalize();
        }
        if !clutched {
            let translation = self.offset + hand.translation * self.scale;
            // With no clutch ever held the orientation keeps its very bits.
            let rotation =
                if self.twist == DQuat::IDENTITY { hand.rotation } else { (hand.rotation * self.twist).normalize() };
            self.world_from_a = Pose::new(translation, rotation);
        }
        self.clutched = clutched;
        self.world_from_a
    }

    /// Whether the clutch is held.
    #[must_use]
    pub fn clutched(&self) -> bool {
        self.clutched
    }

    /// Whether the dead-man switch lets force through.
    #[must_use]
    pub fn alive(&self, sample: &Sample) -> bool {
        self.deadman == 0 || sample.buttons & self.deadman != 0
    }

    /// A's translation over the hand's.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Config;

    fn sample(x: f64, turn: f64, buttons: u32) -> Sample {
        let pose = Pose::from_xyz_rpy(DVec3::X * x, DVec3::Z * turn);
        Sample { pose, buttons, connected: true, ..Default::default() }
    }

    #[test]
    fn identity_keeps_the_bits() {
        let mut mapping = Mapping::new(&Config::default().mapping);
        let s = sample(0.123456789, 0.7, 0);
        assert_eq!(mapping.map(&s), s.pose);
    }

    #[test]
    fn the_clutch_holds_the_part_and_takes_it_up_without_a_jump() {
        let config = MappingConfig { scale: 2.0, clutch_button: 1, ..Config::default().mapping };
        let mut mapping = Mapping::new(&config);
        let before = mapping.map(&sample(0.1, 0.3, 0));
        assert!((before.translation.x - 0.2).abs() < 1e-15);
        for i in 0..10 {
            assert_eq!(mapping.map(&sample(0.1 + 0.01 * f64::from(i), 0.3 + 0.1 * f64::from(i), 2)), before);
        }
        let after = mapping.map(&sample(0.2, 1.5, 0));
        assert!((after.translation - before.translation).length() < 1e-15);
        assert!(before.rotation_to(&after).length() < 1e-12);
        let on = mapping.map(&sample(0.21, 1.6, 0));
        assert!((on.translation.x - before.translation.x - 0.02).abs() < 1e-12);
        assert!((before.rotation_to(&on) - DVec3::Z * 0.1).length() < 1e-12, "about the world's axis");
    }

    #[test]
    fn a_dead_man_switch_must_be_held() {
        let mut config = Config::default().mapping;
        assert!(Mapping::new(&config).alive(&sample(0.0, 0.0, 0)));
        config.deadman_button = 31;
        assert!(!Mapping::new(&config).alive(&sample(0.0, 0.0, 1)));
        assert!(Mapping::new(&config).alive(&sample(0.0, 0.0, 1 << 31)));
    }
}
