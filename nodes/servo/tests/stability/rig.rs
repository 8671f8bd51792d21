//! A hand at a device over a floor, in numbers.

use cspace::{FixedPart, Polyhedron, World};
use haptics::Gains;
use servo::Config;
use spatial::DVec3;
use std::sync::Arc;

/// What a hand adds to the device that it holds.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    pub name: &'static str,
    /// kg, N.s/m, N/m.
    pub mass: f64,
    pub damping: f64,
    pub stiffness: f64,
    /// kg.m^2, N.m.s/rad, N.m/rad.
    pub inertia: f64,
    pub rotation_damping: f64,
    pub rotation_stiffness: f64,
}

/// Two fingers that hardly hold on, and a fist: within what is measured on people (Hogan 1989; Kuchenbecker, Park and
/// Niemeyer 2003; Speich, Shao and Goldfarb 2005).
pub const GRIPS: [Grip; 2] = [
    Grip {
        name: "soft",
        mass: 0.1,
        damping: 1.0,
        stiffness: 100.0,
        inertia: 1e-4,
        rotation_damping: 1.5e-3,
        rotation_stiffness: 0.1,
    },
    Grip {
        name: "stiff",
        mass: 0.4,
        damping: 6.0,
        stiffness: 1000.0,
        inertia: 4e-4,
        rotation_damping: 8e-3,
        rotation_stiffness: 1.0,
    },
];

/// The device's mechanics and electronics.
#[derive(Clone, Copy, Debug)]
pub struct Mechanics {
    /// kg and N.s/m.
    pub mass: f64,
    pub damping: f64,
    /// kg.m^2 and N.m.s/rad.
    pub inertia: f64,
    pub rotation_damping: f64,
    /// Steps of the encoders, metres and rad.
    pub resolution: f64,
    pub angular_resolution: f64,
    /// Time between measuring and showing beyond the hold, s.
    pub delay: f64,
}

/// A desktop arm of the usual size.
pub const DEVICE: Mechanics = Mechanics {
    mass: 0.1,
    damping: 0.2,
    inertia: 1e-4,
    rotation_damping: 5e-4,
    resolution: 1e-5,
    angular_resolution: 5e-5,
    delay: 2e-4,
};

/// Hand, device and the time of a tick.
#[derive(Clone, Copy, Debug)]
pub struct Rig {
    pub grip: Grip,
    pub device: Mechanics,
    /// s.
    pub period: f64,
}

impl Rig {
    /// What the start-up check is told of it.
    pub fn config(&self, gains: &Gains) -> Config {
        let mut config = Config { gains: *gains, ..Config::default() };
        config.realtime.rate = 1.0 / self.period;
        config.stability.damping = self.device.damping + self.grip.damping;
        config.stability.rotation_damping = self.device.rotation_damping + self.grip.rotation_damping;
        config.stability.mass = self.device.mass + self.grip.mass;
        config.stability.inertia = self.device.inertia + self.grip.inertia;
        config.stability.resolution = self.device.resolution;
        config.stability.angular_resolution = self.device.angular_resolution;
        config.stability.delay = self.device.delay;
        config
    }
}

/// Half the edge of the cube in the hand, metres.
pub const HALF: f64 = 0.01;

/// A cube over a plate whose top is the plane z = 0.
pub fn cube_over_floor() -> Arc<World> {
    let floor = cuboid(DVec3::new(-0.1, -0.1, -0.02), DVec3::new(0.1, 0.1, 0.0));
    let cube = cuboid(DVec3::splat(-HALF), DVec3::splat(HALF));
    let fixed = vec![FixedPart { polyhedron: Arc::new(floor), obstacle: 0 }];
    Arc::new(World { moving: vec![Arc::new(cube)], fixed })
}

fn cuboid(low: DVec3, high: DVec3) -> Polyhedron {
    let corner = |i: i32| {
        DVec3::new(
            if i & 1 == 0 { low.x } else { high.x },
            if i & 2 == 0 { low.y } else { high.y },
            if i & 4 == 0 { low.z } else { high.z },
        )
    };
    let corners: Vec<DVec3> = (0..8).map(corner).collect();
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|f| f.to_vec());
    Polyhedron::from_faces(&corners, &faces).expect("a box is a polyhedron")
}
