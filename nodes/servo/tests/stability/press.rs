//! One run: the hand comes down on the floor, presses, is knocked, and ought to come to rest.

use crate::hand::{Freedom, Hand};
use crate::rig::{HALF, Rig};
use cspace::World;
use device::Sample;
use haptics::{Gains, Renderer};
use servo::{Health, Tick, TickInput};
use spatial::{DVec3, Pose, Stamp, Wrench};
use std::sync::Arc;

/// How hard the hand presses, N.
pub const PRESS: f64 = 3.0;
/// The knock, N and N.m, as long as `KNOCK_TIME`.
const KNOCK: Wrench = Wrench { force: DVec3::new(0.0, 0.0, -2.0), torque: DVec3::new(0.02, 0.015, 0.0) };
const KNOCK_TIME: f64 = 4e-3;
/// Height over the floor at the beginning, metres.
const HEIGHT: f64 = 5e-4;
/// When the hand starts to press, when it presses fully, when it is knocked, when it is looked at in between, when the
/// run ends, s.
const START: f64 = 0.02;
const FULL: f64 = 0.07;
const KNOCKED: f64 = 0.8;
const MIDDLE: f64 = 1.8;
const END: f64 = 3.0;
/// Taps a second.
const TAPS: f64 = 4.0;
/// Greatest speed between them, m/s.
const TAP_SPEED: f64 = 0.2;
/// The torque with which it tilts the cube meanwhile, N.m: half of what would turn it over.
const TWIST: f64 = 0.5 * PRESS * HALF;
/// How long the motion is looked at after the knock and before the end, s.
const LOOK: f64 = 0.2;

/// Motion of no more than so many encoder steps is rest: a quantised spring has a limit cycle of one to two, with damping of
/// its quantised rate beside it of up to four.
const REST: f64 = 4.0;
/// Larger motion must have died down to this share since the knock and since the middle, and must not leave the floor.
const DYING: f64 = 0.8;

/// What the hand does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Comes down, presses, is knocked, and ought to come to rest.
    Press,
    /// Taps on the floor, again and again.
    Tap,
}

/// What came of a run.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// It came to rest, or was on its way, under the full force.
    pub stable: bool,
    /// Torque shown before the end, from peak to peak, N.m.
    pub torque: f64,
    /// The most energy that the hand ever had got more than it gave, J.
    pub energy: f64,
}

/// Presses the cube on the floor.
pub fn press(world: &Arc<World>, rig: &Rig, gains: &Gains, freedom: Freedom, task: Task) -> Outcome {
    let config = rig.config(gains);
    let mut tick = Tick::with_law(Box::new(Renderer::new(world.clone())), &config);
    let mut hand = Hand::new(*rig, freedom, Pose::from_xyz_rpy(DVec3::Z * (HALF + HEIGHT), DVec3::ZERO));
    let (mut knocked, mut middle, mut end) = (Spread::default(), Spread::default(), Spread::default());
    // Whether at the end the force is taken back because the energy account is exhausted.
    let mut relieved = false;
    let period_ns = (rig.period * 1e9).round() as i64;
    for i in 0..(END / rig.period) as u64 {
        let t = i as f64 * rig.period;
        let stamp = Stamp((i as i64 + 1) * period_ns);
        let sample = Sample { sequence: i + 1, stamp, pose: hand.measured(), connected: true, ..Sample::default() };
        let input = TickInput {
            sequence: i,
            stamp,
            dt: rig.period,
            sample,
            gains: config.gains,
            enabled: true,
            ..TickInput::default()
        };
        let record = tick.step(&input);
        let shown = record.out_wrench;
        relieved |= t >= END - LOOK && record.health.any(Health::ENERGY);
        hand.tick(&shown, &intended(t, rig, task));
        let turn = Pose::IDENTITY.rotation_to(&hand.pose);
        let now = [hand.pose.translation.z, turn.x, turn.y, shown.torque.x, shown.torque.y];
        if (MIDDLE..MIDDLE + LOOK).contains(&t) {
            middle.take(now);
        }
        if (KNOCKED + KNOCK_TIME..KNOCKED + KNOCK_TIME + LOOK).contains(&t) {
            knocked.take(now);
        }
        if t >= END - LOOK {
            end.take(now);
        }
    }
    let (knocked, middle, after) = (knocked.widths(), middle.widths(), end.widths());
    let rests = |k: usize, step: f64| after[k] <= REST * step || after[k] <= DYING * knocked[k].min(middle[k]);
    let d = &rig.device;
    let in_touch = after[0] <= (PRESS / gains.stiffness).max(REST * d.resolution);
    let turns_rest = rests(1, d.angular_resolution) && rests(2, d.angular_resolution);
    Outcome {
        stable: !relieved && in_touch && rests(0, d.resolution) && turns_rest,
        torque: after[3].max(after[4]),
        energy: hand.most_work,
    }
}

/// What the hand does of its own at time `t`.
fn intended(t: f64, rig: &Rig, task: Task) -> Wrench {
    if task == Task::Tap {
        let rate = std::f64::consts::TAU * TAPS;
        let (g, d) = (&rig.grip, &rig.device);
        // What moves the hand through the air at that speed.
        let force = TAP_SPEED * (g.damping + d.damping).hypot((g.mass + d.mass) * rate - g.stiffness / rate);
        let push = -force * (rate * t).sin();
        return Wrench::new(DVec3::Z * push, DVec3::X * (0.001 * push));
    }
    let tilt = DVec3::X * (TWIST * ((t - START) / (FULL - START)).clamp(0.0, 1.0));
    let push = DVec3::Z * (-PRESS * ((t - START) / (FULL - START)).clamp(0.0, 1.0));
    let pushed = Wrench::new(push, tilt);
    if (KNOCKED..KNOCKED + KNOCK_TIME).contains(&t) { pushed + KNOCK } else { pushed }
}

/// Lowest and highest of five signals.
struct Spread {
    low: [f64; 5],
    high: [f64; 5],
}

impl Default for Spread {
    fn default() -> Self {
        Self { low: [f64::INFINITY; 5], high: [f64::NEG_INFINITY; 5] }
    }
}

impl Spread {
    fn take(&mut self, now: [f64; 5]) {
        for (k, x) in now.into_iter().enumerate() {
            self.low[k] = self.low[k].min(x);
            self.high[k] = self.high[k].max(x);
        }
    }

    fn widths(&self) -> [f64; 5] {
        std::array::from_fn(|k| self.high[k] - self.low[k])
    }
}
