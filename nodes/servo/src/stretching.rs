use haptics::{Displacement, LawKind, LawOutput};
use spatial::{DVec3, Pose};

/// Time in which a rotational stiffness that was once seen is forgotten, s.
const MEMORY: f64 = 0.02;

/// Turns of a hand that does not turn, rad.
const ROUNDING: f64 = 1e-9;

/// Which way the coupling is being stretched, and how stiffly it resists turning.
///
/// Only that part of the hand's motion is to be damped: sliding along a face, where the proxy goes with the hand, is not
/// to be slowed down. It is not the part along the force either: a hand that circles about a peg's axis moves across the
/// force, and a late spring drives it on all the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stretching {
    last: Option<Seen>,
    /// Directions of the last change, of any length; zero if there was none yet.
    linear: DVec3,
    angular: DVec3,
    rotation_stiffness: f64,
    /// Turns smaller than this, rad, are none: rounding, which any change of torque would seem stiff against.
    least_turn: f64,
}

#[derive(Clone, Copy, Debug)]
struct Seen {
    hip: Pose,
    stretch: DVec3,
    turn: DVec3,
    /// Of the law's wrench.
    torque: DVec3,
}

impl Stretching {
    /// Of a hand whose rotation is measured in steps of `angular_resolution`, rad.
    pub fn new(angular_resolution: f64) -> Self {
        Self { least_turn: (0.5 * angular_resolution).max(ROUNDING), ..Self::default() }
    }

    /// Forgets what was seen.
    pub fn reset(&mut self) {
        *self = Self { least_turn: self.least_turn, ..Self::default() };
    }

    /// Looks at this tick's stretch between the law's proxy and the hand at `hip`, `dt` seconds after the last.
    pub fn step(&mut self, hip: &Pose, law: &LawOutput, kind: LawKind, dt: f64) {
        let stretch = hip.translation - law.proxy.translation;
        let turn = law.proxy.rotation_to(hip);
        let Some(last) = &mut self.last else {
            self.last = Some(Seen { hip: *hip, stretch, turn, torque: law.wrench.torque });
            return;
        };
        // Between two samples of a slow device nothing changes, and the directions stay.
        if stretch != last.stretch {
            self.linear = stretch - last.stretch;
            last.stretch = stretch;
        }
        let turned_by = turn - std::mem::replace(&mut last.turn, turn);
        // The other laws have no rotational proxy: what resists is seen in the torque.
        let torque = law.wrench.torque - std::mem::replace(&mut last.torque, law.wrench.torque);
        let last_hip = std::mem::replace(&mut last.hip, *hip);
        if kind == LawKind::Proxy {
            if turned_by != DVec3::ZERO {
                self.angular = turned_by;
            }
            return;
        }
        if torque != DVec3::ZERO {
            self.angular = torque;
        }
        self.rotation_stiffness *= (1.0 - dt / MEMORY).max(0.0);
        let turned = last_hip.rotation_to(hip);
        let square = turned.length_squared();
        if square > self.least_turn * self.least_turn {
            self.rotation_stiffness = self.rotation_stiffness.max(-torque.dot(turned) / square);
        }
    }

    /// The part of a motion that stretches the coupling; all of it where nothing is known.
    pub fn part_of(&self, motion: &Displacement) -> Displacement {
        Displacement { linear: along(motion.linear, self.linear), angular: along(motion.angular, self.angular) }
    }

    /// Rotational stiffness of a law without a rotational proxy, N.m/rad: the greatest of late.
    pub fn rotation_stiffness(&self) -> f64 {
        self.rotation_stiffness
    }
}

/// The part of a motion along a direction, all of it if there is none.
fn along(motion: DVec3, direction: DVec3) -> DVec3 {
    let square = direction.length_squared();
    if square > 0.0 { direction * (motion.dot(direction) / square) } else { motion }
}
