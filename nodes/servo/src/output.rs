use crate::stretching::Stretching;
use crate::{Config, Health};
use haptics::{
    Coupling, Displacement, Gains, Held, LawKind, LawOutput, Limiter, Passivity, PassivityLimits, clamped,
    returnable_energy,
};
use spatial::{Pose, Twist, Wrench};

/// Time in which force fades when the clutch is taken, s.
const CLUTCH_FADE: f64 = 0.02;
/// Time in which force goes down when the energy account is exhausted, s.
const RELIEF_FADE: f64 = 0.05;
/// Time in which it comes back, s.
const RELIEF_RETURN: f64 = 0.5;
/// The least share of the force that is left while the account is exhausted.
const RELIEF_LEAST: f64 = 0.1;

/// What a tick has to show.
pub struct Rendered<'a> {
    /// The law's answer.
    pub law: &'a LawOutput,
    /// The part's pose.
    pub hip: &'a Pose,
    /// The part's velocity.
    pub twist: &'a Twist,
    /// What the hand moved since the last tick.
    pub moved: &'a Displacement,
    /// What it is about to move in this tick, at the rate of its last samples.
    pub moving: &'a Displacement,
    /// Measured at the robot.
    pub remote: &'a Wrench,
    /// A's translation over the hand's.
    pub scale: f64,
    /// The clutch is held.
    pub clutched: bool,
    /// The past does not count: a reset or a jump.
    pub restart: bool,
    /// Force is wanted.
    pub enabled: bool,
    /// Corner frequency of velocities, Hz.
    pub cutoff: f64,
}

/// From the law's wrench to the device's: damping, ramp, passivity, limits, and nothing at all when anything is wrong.
pub struct Output {
    coupling: Coupling,
    passivity: Passivity,
    passivity_limits: PassivityLimits,
    limiter: Limiter,
    ramp: f64,
    last_ramp: f64,
    relief: f64,
    share: f64,
    stretching: Stretching,
    /// Steps of the encoders, metres and rad.
    resolution: (f64, f64),
}

impl Output {
    /// No force yet.
    pub fn new(config: &Config) -> Self {
        let passivity = &config.passivity;
        Self {
            coupling: Coupling::default(),
            passivity: Passivity::default(),
            passivity_limits: PassivityLimits {
                max_damping: passivity.max_damping,
                lever: passivity.lever,
                budget: passivity.budget,
                delay: config.stability.delay,
                mass: config.stability.mass,
                inertia: config.stability.inertia,
            },
            limiter: Limiter::default(),
            ramp: 0.0,
            last_ramp: 0.0,
            relief: 1.0,
            share: 0.0,
            stretching: Stretching::new(config.stability.angular_resolution),
            resolution: (config.stability.resolution, config.stability.angular_resolution),
        }
    }

    /// The wrench for the device, N and N.m on the hand.
    pub fn step(&mut self, r: &Rendered<'_>, gains: &Gains, dt: f64, health: &mut Health) -> Wrench {
        if r.restart {
            self.coupling.reset();
            self.stretching.reset();
        }
        let damping = self.coupling.damping(r.law, r.hip, r.twist, gains, dt, r.cutoff);
        if !r.remote.is_finite() {
            health.set(Health::FAULT);
        }
        if r.restart || !r.enabled || health.any(Health::ZERO_FORCE) {
            self.cut();
            return Wrench::ZERO;
        }
        self.advance_ramp(r, gains, dt);
        let control = self.control(r, gains, dt, health);
        let remote = *r.remote * self.share;
        let local = self.paid_for((r.law.wrench + damping) * self.share + control, r, gains, dt);
        let asked = local + remote;
        if !asked.is_finite() {
            health.set(Health::FAULT);
            self.cut();
            return Wrench::ZERO;
        }
        let limited = self.limiter.step(&asked, gains, dt);
        if limited.saturated {
            health.set(Health::SATURATED);
        }
        self.passivity.shown(limited.wrench - remote, remote);
        limited.wrench
    }

    fn advance_ramp(&mut self, r: &Rendered<'_>, gains: &Gains, dt: f64) {
        self.ramp = if r.clutched {
            (self.ramp - dt / CLUTCH_FADE).max(0.0)
        } else {
            (self.ramp + dt / gains.ramp_time).min(1.0)
        };
    }

    /// Books the tick and gives what the passivity controller adds.
    fn control(&mut self, r: &Rendered<'_>, gains: &Gains, dt: f64, health: &mut Health) -> Wrench {
        self.stretching.step(r.hip, r.law, gains.law, dt);
        let limits = self.passivity_limits;
        let returnable = |share| returnable_energy(r.law.energy, &r.law.wrench, share, gains, r.scale);
        let last_ramp = std::mem::replace(&mut self.last_ramp, self.ramp);
        self.share = self.ramp * self.relief;
        let stored = returnable(self.share);
        // Only the ramp is asked for: what the relief gives back must be paid for.
        let ramped = if self.ramp == last_ramp { 0.0 } else { stored - returnable(last_ramp * self.relief) };
        let stiffness = if stored > 0.0 {
            let turn = match gains.law {
                LawKind::Proxy => gains.rotation_stiffness,
                _ => self.stretching.rotation_stiffness(),
            };
            (self.share * gains.stiffness * r.scale, self.share * turn)
        } else {
            (0.0, 0.0)
        };
        let unsure = 0.5 * (stiffness.0 * self.resolution.0.powi(2) + stiffness.1 * self.resolution.1.powi(2));
        let held = Held { stored, ramped, unsure };
        self.passivity.observe(r.moved, &held, dt, &limits);
        if !gains.passivity {
            self.relief = 1.0;
            return Wrench::ZERO;
        }
        self.relief = if self.passivity.exhausted(&limits) {
            health.set(Health::ENERGY);
            (self.relief - dt / RELIEF_FADE).max(RELIEF_LEAST)
        } else {
            (self.relief + dt / RELIEF_RETURN).min(1.0)
        };
        if r.clutched {
            // The hand is on its own way; what it moves is no motion of the part.
            return Wrench::ZERO;
        }
        self.passivity.control(&self.stretching.part_of(r.moving), stiffness, dt, &limits)
    }

    /// As much of the local wrench as what the hand has put in pays for, seen as the limiter will show it.
    fn paid_for(&self, local: Wrench, r: &Rendered<'_>, gains: &Gains, dt: f64) -> Wrench {
        if !gains.passivity || r.clutched {
            return local;
        }
        let shown = clamped(&local, gains);
        let share = self.passivity.affordable(&shown, r.moving, dt, &self.passivity_limits);
        if share < 1.0 { shown * share } else { local }
    }

    /// No force at once, and from zero again afterwards.
    fn cut(&mut self) {
        self.limiter.cut();
        self.passivity.reset();
        (self.ramp, self.last_ramp, self.share) = (0.0, 0.0, 0.0);
    }

    /// The energy account, J.
    pub fn energy(&self) -> f64 {
        self.passivity.energy()
    }
}
