use crate::arm::Arm;
use crate::operator_plan::turned_about;
use crate::stroke::Stroke;
use crate::tremor::Tremor;
use crate::{DeviceSpec, HapticDevice, OperatorConfig, OperatorError, OperatorPlan, Sample, Waypoint};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use spatial::{DVec3, Pose, Stamp, Twist, Wrench};

/// A person at a haptic device, simulated: intends a plan, holds the handle with an arm of finite stiffness and a
/// trembling hand, aims a little beside, and feels the wrench.
///
/// Its motion is a function of seed, plan, the times of `read` and the wrenches written, and of nothing else. Time is
/// cut into steps of 0.1 ms, so that loops of 250 Hz to 10 kHz feel the same arm.
#[derive(Debug)]
pub struct SimulatedOperator {
    spec: DeviceSpec,
    config: OperatorConfig,
    plan: OperatorPlan,
    rng: Pcg64,
    tremor: Tremor,
    arm: Arm,
    stroke: Stroke,
    /// Index of the waypoint that `stroke` leads to.
    waypoint: usize,
    /// Steps since the stroke began.
    stroke_steps: u64,
    /// Steps since the beginning.
    steps: u64,
    /// This round's error of aim, and how the part is held askew.
    aim: DVec3,
    askew: DVec3,
    /// How far the hand has yielded to what it feels: metres across `up`, and rad.
    yielded: (DVec3, DVec3),
    felt: Wrench,
    last_read: Option<Stamp>,
    /// Time that was read but fills no whole step yet, ns.
    rest_ns: i64,
    sequence: u64,
}

const STEP_NS: i64 = 100_000;
const STEP: f64 = STEP_NS as f64 * 1e-9;
/// The most time that one call makes up for: a longer gap (a clock step, a stopped process) is time that did not pass.
const MOST_NS: i64 = 50_000_000;
/// The circling search, and its turning to and fro, Hz: apart, so that they meet at every phase.
const WIGGLE_HZ: f64 = 1.9;
const WIGGLE_TURN_HZ: f64 = 1.3;
/// A hand does not insist: what it intends gives way to a lasting wrench, m/(N.s) and rad/(N.m.s), ...
const YIELD: (f64, f64) = (1.5e-3, 6.0);
/// ... forgets that at this rate, 1/s, ...
const FORGET: f64 = 0.5;
/// ... and gives way no further than this, metres and rad.
const YIELD_MOST: (f64, f64) = (1.5e-3, 0.07);

/// Where the search takes the intention: metres, m/s, rad, rad/s.
#[derive(Clone, Copy, Debug, Default)]
struct Search {
    shift: DVec3,
    shift_rate: DVec3,
    turn: DVec3,
    turn_rate: DVec3,
}

impl SimulatedOperator {
    /// An operator who starts at rest at the plan's start.
    ///
    /// # Errors
    /// A number of the configuration or of the plan is out of range.
    pub fn new(config: OperatorConfig, plan: OperatorPlan) -> Result<Self, OperatorError> {
        config.check()?;
        plan.check()?;
        let mut rng = Pcg64::seed_from_u64(config.seed);
        let tremor = Tremor::new(&mut rng, config.tremor_force, config.tremor_torque, STEP);
        let mut this = Self {
            spec: DeviceSpec::force_feedback("simulated"),
            arm: Arm::new(plan.start, config),
            stroke: Stroke::new(plan.start, &plan.start, 1.0),
            config,
            plan,
            rng,
            tremor,
            waypoint: 0,
            stroke_steps: 0,
            steps: 0,
            aim: DVec3::ZERO,
            askew: DVec3::ZERO,
            yielded: (DVec3::ZERO, DVec3::ZERO),
            felt: Wrench::ZERO,
            last_read: None,
            rest_ns: 0,
            sequence: 0,
        };
        this.err_anew();
        this.arm.pose = this.with_errors(&this.plan.start);
        this.head_for(0, this.arm.pose);
        Ok(this)
    }

    /// Draws the errors of the next round.
    fn err_anew(&mut self) {
        let across = self.plan.up.any_orthonormal_vector();
        let angle = std::f64::consts::TAU * self.rng.random::<f64>();
        let aside = across * angle.cos() + self.plan.up.cross(across) * angle.sin();
        self.aim = aside * self.config.aim_error;
        // Uniform on the sphere (Archimedes).
        let z = 2.0 * self.rng.random::<f64>() - 1.0;
        let (sin, cos) = (std::f64::consts::TAU * self.rng.random::<f64>()).sin_cos();
        let r = (1.0 - z * z).sqrt();
        self.askew = DVec3::new(r * cos, r * sin, z) * self.config.misalignment;
    }

    fn with_errors(&self, pose: &Pose) -> Pose {
        let turned = turned_about(pose, self.plan.tip_a, self.askew);
        Pose::new(turned.translation + self.aim, turned.rotation)
    }

    fn head_for(&mut self, waypoint: usize, from: Pose) {
        let w = self.plan.waypoints[waypoint];
        self.waypoint = waypoint;
        self.stroke_steps = 0;
        self.stroke = Stroke::new(from, &self.with_errors(&w.pose), w.duration / self.config.speed);
    }

    fn step(&mut self) {
        self.steps += 1;
        self.stroke_steps += 1;
        let t = self.stroke_steps as f64 * STEP;
        let (on_path, twist) = self.stroke.at(t);
        let w = self.plan.waypoints[self.waypoint];
        let search = self.search(&w);
        self.give_way();
        let (shift, turn) = (self.yielded.0 + search.shift, self.yielded.1 + search.turn);
        let wanted = turned_about(&on_path, self.plan.tip_a, turn);
        let wanted = Pose::new(wanted.translation + shift, wanted.rotation);
        let wanted_twist =
            Twist { linear: twist.linear + search.shift_rate, angular: twist.angular + search.turn_rate };
        let push = self.felt + self.tremor.step();
        self.arm.step(&wanted, &wanted_twist, &push, STEP);
        if t >= self.stroke.duration() || self.felt.force.length() > w.guard {
            let next = (self.waypoint + 1) % self.plan.waypoints.len();
            if next == 0 {
                self.err_anew();
            }
            self.head_for(next, on_path);
        }
    }

    /// Lets the intention follow the felt wrench a little.
    fn give_way(&mut self) {
        let across = self.felt.force.reject_from_normalized(self.plan.up);
        let (shift, turn) = self.yielded;
        let shift = shift + (across * YIELD.0 - shift * FORGET) * STEP;
        let turn = turn + (self.felt.torque * YIELD.1 - turn * FORGET) * STEP;
        self.yielded = (shift.clamp_length_max(YIELD_MOST.0), turn.clamp_length_max(YIELD_MOST.1));
    }

    /// The search's offset and its rate; it swells and fades with the stroke.
    fn search(&self, waypoint: &Waypoint) -> Search {
        let t = self.stroke_steps as f64 * STEP;
        if waypoint.wiggle == 0.0 && waypoint.wiggle_turn == 0.0 {
            return Search::default();
        }
        let fade = std::f64::consts::PI / self.stroke.duration();
        let (swell, swell_rate) = ((fade * t).sin().max(0.0), (fade * t).cos() * fade);
        let (omega, omega_turn) = (std::f64::consts::TAU * WIGGLE_HZ, std::f64::consts::TAU * WIGGLE_TURN_HZ);
        let (sin, cos) = (omega * t).sin_cos();
        let (turn_sin, turn_cos) = (omega_turn * t).sin_cos();
        let x = self.plan.up.any_orthonormal_vector();
        let y = self.plan.up.cross(x);
        let (around, ahead) = (x * cos + y * sin, (y * cos - x * sin) * omega);
        Search {
            shift: around * (waypoint.wiggle * swell),
            shift_rate: (around * swell_rate + ahead * swell) * waypoint.wiggle,
            turn: self.plan.up * (waypoint.wiggle_turn * swell * turn_sin),
            turn_rate: self.plan.up * (waypoint.wiggle_turn * (swell_rate * turn_sin + swell * turn_cos * omega_turn)),
        }
    }

    /// Where the hand is, A in the base frame.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.arm.pose
    }

    /// Index of the waypoint that the hand heads for.
    #[must_use]
    pub fn waypoint(&self) -> usize {
        self.waypoint
    }
}

impl HapticDevice for SimulatedOperator {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read(&mut self, now: Stamp) -> Sample {
        let elapsed = self.last_read.map_or(0, |last| now.0.saturating_sub(last.0));
        self.last_read = Some(now);
        self.rest_ns += elapsed.clamp(0, MOST_NS);
        while self.rest_ns >= STEP_NS {
            self.rest_ns -= STEP_NS;
            self.step();
        }
        self.sequence += 1;
        Sample {
            sequence: self.sequence,
            stamp: now,
            pose: self.arm.pose,
            twist: self.arm.twist,
            has_twist: true,
            buttons: 0,
            connected: true,
        }
    }

    fn write(&mut self, wrench: &Wrench) {
        self.felt = if wrench.is_finite() { *wrench } else { Wrench::ZERO };
    }
}

#[cfg(test)]
#[path = "simulated_operator_tests.rs"]
mod tests;
