use crate::gain_ramp::GainRamp;
use crate::mapping::Mapping;
use crate::motion::Motion;
use crate::output::{Output, Rendered};
use crate::sample_check::SampleCheck;
use crate::{Config, Health, TickInput, TickRecord};
use haptics::{LawOutput, RenderLaw, Renderer};
use scene::Scene;
use spatial::{Pose, Twist, Wrench};

/// Time after which a step in time counts no further, s.
const LONGEST: f64 = 1.0;
/// Steps in time are never shorter, s.
const SHORTEST: f64 = 1e-6;

/// One tick as a pure function of its state and input: no clock, no I/O, no allocation, no `Result`. The same inputs give
/// the same records, bit for bit; trouble shows as health bits.
pub struct Tick {
    law: Box<dyn RenderLaw>,
    check: SampleCheck,
    mapping: Mapping,
    motion: Motion,
    gains: GainRamp,
    output: Output,
    /// Metres in a tick that are a jump.
    jump_distance: f64,
    /// The turn in a tick that is one: see [`chord_squared`].
    jump_chord_squared: f64,
    cutoff: f64,
    period: f64,
    reset_count: Option<u32>,
    last_hip: Option<Pose>,
}

impl Tick {
    /// A tick over a scene.
    #[must_use]
    pub fn new(scene: &Scene, config: &Config) -> Self {
        Self::with_law(Box::new(renderer(scene)), config)
    }

    /// A tick that renders by a law of the caller's.
    #[must_use]
    pub fn with_law(law: Box<dyn RenderLaw>, config: &Config) -> Self {
        Self {
            law,
            check: SampleCheck::new(config.device.timeout),
            mapping: Mapping::new(&config.mapping),
            motion: Motion::new(config.mapping.velocity_cutoff),
            gains: GainRamp::default(),
            output: Output::new(config),
            jump_distance: config.jump.distance,
            jump_chord_squared: chord_squared_of(config.jump.angle),
            cutoff: config.mapping.velocity_cutoff,
            period: config.realtime.period(),
            reset_count: None,
            last_hip: None,
        }
    }

    /// One tick.
    pub fn step(&mut self, input: &TickInput) -> TickRecord {
        let mut health = input.outside;
        let dt = self.duration(input.dt, &mut health);
        let gains = self.gains.step(&input.gains, dt);
        let checked = self.check.check(&input.sample, input.stamp);
        health.set(checked.health);
        let reset = self.reset_count.replace(input.reset_count).is_some_and(|n| n != input.reset_count);
        let Some(sample) = checked.sample else {
            // Nothing is known of the hand yet.
            return TickRecord { input: *input, health, ..TickRecord::default() };
        };
        if !self.mapping.alive(&input.sample) {
            health.set(Health::DEADMAN);
        }

        let moved = self.motion.step(&sample, checked.fresh, dt);
        let hip = self.mapping.map(&sample);
        let jumped = self.jumped(&hip);
        if jumped {
            health.set(Health::JUMP);
        }
        if reset || jumped {
            self.law.reset();
            self.motion.restart();
            health.set(Health::RESEEDED);
        }
        let twist = self.twist();
        let mut law = LawOutput::free(hip);
        self.law.render_into(&hip, &gains, dt, &mut law);
        self.check(&mut law, &hip, &mut health);

        let rendered = Rendered {
            law: &law,
            hip: &hip,
            twist: &twist,
            moved: &moved,
            moving: &self.motion.in_a_tick(dt),
            remote: &input.remote,
            scale: self.mapping.scale(),
            clutched: self.mapping.clutched(),
            restart: reset || jumped,
            enabled: input.enabled,
            cutoff: self.cutoff,
        };
        let out_wrench = self.output.step(&rendered, &gains, dt, &mut health);
        TickRecord {
            input: *input,
            hip,
            twist,
            proxy: law.proxy,
            depth: law.depth,
            formation: law.formation,
            law_wrench: law.wrench,
            out_wrench,
            energy: self.output.energy(),
            health,
            wakeup_ns: 0,
            compute_ns: 0,
        }
    }

    fn duration(&self, dt: f64, health: &mut Health) -> f64 {
        if dt.is_nan() {
            health.set(Health::FAULT);
            return self.period;
        }
        dt.clamp(SHORTEST, LONGEST)
    }

    fn jumped(&mut self, hip: &Pose) -> bool {
        let last = self.last_hip.replace(*hip).unwrap_or(*hip);
        (hip.translation - last.translation).length() > self.jump_distance
            || chord_squared(&last, hip) > self.jump_chord_squared
    }

    /// Velocity of the part, which stands still while the clutch is held.
    fn twist(&self) -> Twist {
        if self.mapping.clutched() {
            return Twist::ZERO;
        }
        let hand = self.motion.twist();
        Twist { linear: hand.linear * self.mapping.scale(), ..hand }
    }

    /// What the law says of itself, and nothing of it where it is no number.
    fn check(&mut self, law: &mut LawOutput, hip: &Pose, health: &mut Health) {
        let finite = law.wrench.is_finite() && law.proxy.is_valid() && law.depth >= 0.0 && law.energy.is_finite();
        if !finite {
            health.set(Health::FAULT);
            self.law.reset();
            (law.wrench, law.proxy, law.depth, law.energy) = (Wrench::ZERO, *hip, 0.0, 0.0);
        }
        for (set, bit) in
            [(law.reseeded, Health::RESEEDED), (law.divergent, Health::DIVERGENT), (law.dropped > 0, Health::OVERFLOW)]
        {
            if set {
                health.set(bit);
            }
        }
    }
}

/// The square of the distance between the unit quaternions of two orientations, of either sign: it grows with the angle between them.
fn chord_squared(from: &Pose, to: &Pose) -> f64 {
    (from.rotation - to.rotation).length_squared().min((from.rotation + to.rotation).length_squared())
}

/// The same of two orientations this angle apart, radians.
fn chord_squared_of(angle: f64) -> f64 {
    let half = 2.0 * (0.25 * angle.min(std::f64::consts::TAU)).sin();
    half * half
}

/// The renderer of a scene, with the friction that the scene states.
#[must_use]
pub fn renderer(scene: &Scene) -> Renderer {
    let own = |f: f64| haptics::Coefficients { statically: f, kinetically: f };
    let friction: Vec<_> = scene.frictions().into_iter().map(|f| f.map(own)).collect();
    Renderer::with_friction(scene.world.clone(), &friction)
}
