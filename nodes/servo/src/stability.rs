use crate::Config;
use crate::config::StabilityPolicy;
use haptics::{HoldDamping, LawKind, SampledLoop};
use scene::Scene;
use std::fmt;

/// A bound of stability that the configuration does not keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StabilityFinding {
    /// The loop of spring, hold, delay, virtual damping and passivity controller against the mass of the hand has a root
    /// outside the unit circle: it runs away, whatever the hand does.
    Unstable {
        /// Which motion.
        motion: MotionKind,
        /// Stiffness, N/m or N.m/rad.
        stiffness: f64,
        /// The largest that comes to rest.
        largest: f64,
    },
    /// So does the virtual damping alone: it comes late and filtered.
    Damping {
        /// Which motion.
        motion: MotionKind,
        /// Virtual damping, N.s/m or N.m.s/rad.
        damping: f64,
        /// The largest that comes to rest.
        largest: f64,
    },
    /// The loop comes to rest, but so near to its limit the passivity controller cannot keep the hand from being given energy.
    Lively {
        /// Which motion.
        motion: MotionKind,
        /// Stiffness, N/m or N.m/rad.
        stiffness: f64,
        /// The largest at which the hand is given none.
        largest: f64,
    },
    /// The sampled wall is active: `b < K (T/2 + t_d) + B` (Colgate and Schenkel 1997; a delay counts like half a period).
    Active {
        /// Which motion.
        motion: MotionKind,
        /// Stiffness, N/m or N.m/rad.
        stiffness: f64,
        /// Greatest stiffness that the damping of device and hand bears.
        bearable: f64,
        /// Whether the passivity controller is there to make up for it.
        controlled: bool,
    },
    /// Law `blended`: a face that lies flat turns as stiffly as `2 F L^2 / delta`, which needs
    /// `delta > 2 F L^2 (T/2 + t_d) / b`.
    BlendDepth {
        /// Depth over which contacts fade, metres.
        blend_depth: f64,
        /// Least depth that the rotational damping bears, metres.
        needed: f64,
    },
}

/// Which motion a bound is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// Translation: N/m, N.s/m.
    Translation,
    /// Rotation: N.m/rad, N.m.s/rad.
    Rotation,
}

impl MotionKind {
    /// Parameters of stiffness and damping, and the unit of the former.
    fn names(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Translation => ("gains.stiffness", "gains.damping", "N/m"),
            Self::Rotation => ("gains.rotation_stiffness", "gains.rotation_damping", "N.m/rad"),
        }
    }
}

impl fmt::Display for StabilityFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Unstable { motion, stiffness, largest } => {
                let (name, _, unit) = motion.names();
                write!(
                    f,
                    "{name} = {stiffness} {unit}: the contact will run away; at this rate, delay, mass and damping \
                     {largest:.3} {unit} is the largest that comes to rest"
                )
            }
            Self::Damping { motion, damping, largest } => {
                let (_, name, unit) = motion.names();
                write!(
                    f,
                    "{name} = {damping} {unit}.s: damping that comes so late will run away by itself; {largest:.3} {unit}.s \
                     is the largest that comes to rest"
                )
            }
            Self::Lively { motion, stiffness, largest } => {
                let (name, _, unit) = motion.names();
                write!(
                    f,
                    "{name} = {stiffness} {unit}: the contact may hum and give energy to the hand; at this rate, delay and mass \
                     {largest:.3} {unit} is the largest that the passivity controller makes up for"
                )
            }
            Self::Active { motion, stiffness, bearable, controlled } => {
                let (name, _, unit) = motion.names();
                let rest = if controlled {
                    "the passivity controller has to make up for it"
                } else {
                    "the contact may hum and give energy to the hand"
                };
                write!(
                    f,
                    "{name} = {stiffness} {unit}: at this rate, delay and damping {bearable:.3} {unit} is the bound; {rest}"
                )
            }
            Self::BlendDepth { blend_depth, needed } => write!(
                f,
                "gains.blend_depth = {blend_depth} m: a face lying flat will hum, {needed:.1e} m is the bound at this rate, \
                 delay, greatest force and rotational damping"
            ),
        }
    }
}

/// What a configuration renders in one motion, and against what, as the hand feels it.
#[derive(Clone, Copy, Debug)]
pub struct RenderedMotion {
    /// Device, hand and sampling.
    pub sampled: SampledLoop,
    /// Stiffness and virtual damping at the hand.
    pub stiffness: f64,
    /// See `stiffness`.
    pub damping: f64,
    /// The passivity controller, if it acts.
    pub controller: Option<HoldDamping>,
    /// What the gains are multiplied by on the way to the hand.
    scale: f64,
}

impl RenderedMotion {
    /// What `config` makes of a motion.
    #[must_use]
    pub fn new(config: &Config, motion: MotionKind) -> Self {
        let (g, s) = (&config.gains, &config.stability);
        let sampled = |mass, damping| SampledLoop {
            mass,
            damping,
            grip: 0.0,
            period: config.realtime.period(),
            delay: s.delay,
            cutoff: config.mapping.velocity_cutoff,
        };
        let (max, lever) = (config.passivity.max_damping, config.passivity.lever);
        let (sampled, stiffness, damping, max, scale) = match motion {
            MotionKind::Translation => (sampled(s.mass, s.damping), g.stiffness, g.damping, max, config.mapping.scale),
            MotionKind::Rotation => (
                sampled(s.inertia, s.rotation_damping),
                g.rotation_stiffness,
                g.rotation_damping,
                max * lever * lever,
                1.0,
            ),
        };
        let controller = g.passivity.then_some(HoldDamping { max });
        Self { sampled, stiffness: stiffness * scale, damping: damping * scale, controller, scale }
    }

    /// The largest stiffness at the hand that comes to rest.
    #[must_use]
    pub fn largest_stiffness(&self) -> f64 {
        self.sampled.largest_stiffness(self.damping, self.controller)
    }

    /// The largest stiffness at the hand up to which the passivity controller keeps the hand from being given energy; without one
    /// there is none.
    #[must_use]
    pub fn largest_passive_stiffness(&self) -> Option<f64> {
        self.controller.map(|c| self.sampled.largest_passive_stiffness(self.damping, c))
    }

    fn findings(&self, motion: MotionKind) -> impl Iterator<Item = StabilityFinding> {
        let (stiffness, damping) = (self.stiffness / self.scale, self.damping / self.scale);
        let largest = self.sampled.largest_damping() / self.scale;
        let runs_away = (damping >= largest).then_some(StabilityFinding::Damping { motion, damping, largest });
        let largest = self.largest_stiffness() / self.scale;
        let unstable = (stiffness >= largest && runs_away.is_none()).then_some(StabilityFinding::Unstable {
            motion,
            stiffness,
            largest,
        });
        let passive = self.largest_passive_stiffness().map(|k| k / self.scale);
        let lively = passive
            .filter(|k| stiffness >= *k && runs_away.is_none() && unstable.is_none())
            .map(|largest| StabilityFinding::Lively { motion, stiffness, largest });
        // Virtual damping counts against it, as Colgate and Schenkel have it: it comes late like the stiffness.
        let hold = 0.5 * self.sampled.period + self.sampled.delay;
        let bearable = (self.sampled.damping - self.damping).max(0.0) / (hold * self.scale);
        let controlled = self.controller.is_some();
        let active = (stiffness > bearable && lively.is_none()).then_some(StabilityFinding::Active {
            motion,
            stiffness,
            bearable,
            controlled,
        });
        [runs_away, unstable, lively, active].into_iter().flatten()
    }
}

/// The bounds that a configuration does not keep, for a part of which contact regions are at most `width` metres across;
/// those that the loop does not survive first.
#[must_use]
pub fn stability_findings(config: &Config, width: f64) -> Vec<StabilityFinding> {
    let (g, s) = (&config.gains, &config.stability);
    let mut findings: Vec<_> =
        RenderedMotion::new(config, MotionKind::Translation).findings(MotionKind::Translation).collect();
    // Without a rotational proxy the torque follows the force: its stiffness is that of the translation at the lever.
    if g.law == LawKind::Proxy {
        findings.extend(RenderedMotion::new(config, MotionKind::Rotation).findings(MotionKind::Rotation));
    }
    if g.law == LawKind::Blended {
        let hold = 0.5 * config.realtime.period() + s.delay;
        let needed = 2.0 * g.max_force * width * width * hold / (s.rotation_damping + g.rotation_damping);
        if g.blend_depth < needed {
            findings.push(StabilityFinding::BlendDepth { blend_depth: g.blend_depth, needed });
        }
    }
    findings.sort_by_key(|f| matches!(f, StabilityFinding::Active { .. } | StabilityFinding::BlendDepth { .. }));
    findings
}

/// The check at start, as `stability.check` wants it: what to warn of.
///
/// # Errors
/// The first bound that is not kept, if the policy is to refuse.
pub fn check_stability(config: &Config, scene: &Scene) -> Result<Vec<StabilityFinding>, StabilityFinding> {
    let findings = stability_findings(config, widest_face(scene));
    match (config.stability.check, findings.first()) {
        (StabilityPolicy::Off, _) => Ok(Vec::new()),
        (StabilityPolicy::Refuse, Some(first)) => Err(*first),
        _ => Ok(findings),
    }
}

/// How far two points of one face of the part in the hand are apart at most, metres.
fn widest_face(scene: &Scene) -> f64 {
    let mut widest = 0.0f64;
    for part in &scene.world.moving {
        for face in part.faces() {
            let corners = part.face_vertices(face);
            for v in corners {
                for w in corners {
                    widest = widest.max(part.vertex(*v).distance(part.vertex(*w)));
                }
            }
        }
    }
    widest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a mass (kg) with damping (N.s/m) on a sampled and held spring comes to rest: exact between samples.
    fn comes_to_rest(mass: f64, damping: f64, stiffness: f64, period: f64) -> bool {
        let (mut x, mut v) = (1e-3f64, 0.0f64);
        let decay = (-damping / mass * period).exp();
        let energy = |x: f64, v: f64| 0.5 * stiffness * x * x + 0.5 * mass * v * v;
        let start = energy(x, v);
        for _ in 0..200_000 {
            // m v' = F - b v with F held.
            let terminal = -stiffness * x / damping;
            x += terminal * period + (v - terminal) * (mass / damping) * (1.0 - decay);
            v = terminal + (v - terminal) * decay;
            if energy(x, v) > 10.0 * start {
                return false;
            }
        }
        energy(x, v) < start
    }

    fn config(stiffness: f64, damping: f64, period: f64) -> Config {
        let mut c = Config::default();
        (c.gains.stiffness, c.gains.damping, c.stability.damping, c.realtime.rate) =
            (stiffness, 0.0, damping, 1.0 / period);
        c
    }

    fn bound(damping: f64, period: f64) -> f64 {
        let found = stability_findings(&config(2e4, damping, period), 0.03);
        let active = found.iter().find_map(|f| match f {
            StabilityFinding::Active { motion: MotionKind::Translation, bearable, .. } => Some(*bearable),
            _ => None,
        });
        active.unwrap_or_else(|| panic!("{found:?}"))
    }

    #[test]
    fn the_predicted_stiffness_is_the_largest_stable_one_within_a_fifth() {
        for period in [0.25e-3, 0.5e-3, 1e-3, 2e-3] {
            for (mass, damping) in [(1.0, 0.2), (0.5, 0.3), (0.1, 0.1)] {
                let (mut low, mut high) = (1.0, 1e5);
                while high / low > 1.01 {
                    let middle = f64::sqrt(low * high);
                    if comes_to_rest(mass, damping, middle, period) { low = middle } else { high = middle }
                }
                let predicted = bound(damping, period);
                assert!((predicted / low - 1.0).abs() < 0.2, "{period} s, {mass} kg: {predicted} of {low} N/m");
            }
        }
    }

    #[test]
    fn a_delay_counts_like_half_a_period_and_virtual_damping_against() {
        let mut c = config(1000.0, 1.0, 1e-3);
        assert!(stability_findings(&c, 0.03).is_empty());
        c.stability.delay = 1e-3;
        assert!(matches!(stability_findings(&c, 0.03)[..], [StabilityFinding::Active { bearable, .. }]
            if (bearable - 1.0 / 1.5e-3).abs() < 1e-9));
        c.stability.delay = 0.0;
        c.gains.damping = 0.9;
        assert_eq!(stability_findings(&c, 0.03).len(), 1);
    }

    #[test]
    fn the_blended_law_needs_depth_for_its_lever() {
        let mut c = Config::default();
        c.gains.law = LawKind::Blended;
        let needed = |c: &Config| {
            stability_findings(c, 0.03).iter().find_map(|f| match f {
                StabilityFinding::BlendDepth { needed, .. } => Some(*needed),
                _ => None,
            })
        };
        c.gains.blend_depth = 1e-6;
        let bound = needed(&c).unwrap();
        // F L^2 T / b
        let b = c.stability.rotation_damping + c.gains.rotation_damping;
        assert!((bound - 10.0 * 9e-4 * 1e-3 / b).abs() < 1e-12);
        c.gains.blend_depth = bound * 1.01;
        assert_eq!(needed(&c), None);
    }

    #[test]
    fn the_defaults_keep_every_bound_and_each_finding_is_one_line() {
        assert_eq!(stability_findings(&Config::default(), 0.03), vec![]);
        let mut c = Config::default();
        (c.gains.stiffness, c.gains.rotation_stiffness) = (2e4, 100.0);
        c.gains.damping = 1e4;
        c.mapping.scale = 0.5;
        let found = stability_findings(&c, 0.03);
        assert!(matches!(found[0], StabilityFinding::Damping { motion: MotionKind::Translation, .. }), "{found:?}");
        assert!(matches!(found[1], StabilityFinding::Unstable { motion: MotionKind::Rotation, .. }), "{found:?}");
        assert!(matches!(found[2..], [StabilityFinding::Active { .. }, StabilityFinding::Active { .. }]), "{found:?}");
        assert!(found.iter().all(|f| f.to_string().lines().count() == 1 && f.to_string().contains("gains.")));
    }
}
