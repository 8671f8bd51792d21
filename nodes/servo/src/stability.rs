use crate::Config;
use crate::config::StabilityPolicy;
use haptics::LawKind;
use scene::Scene;
use std::fmt;

/// A bound of stability that the configuration does not keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StabilityFinding {
    /// The sampled wall is active: `b < K (T/2 + t_d) + B` (Colgate and Schenkel 1997; a delay counts like half a period).
    Stiffness {
        /// Stiffness, N/m.
        stiffness: f64,
        /// Greatest stiffness that the damping bears, N/m.
        bearable: f64,
        /// Whether the passivity controller is there to make up for it.
        controlled: bool,
    },
    /// The same for the rotation.
    RotationStiffness {
        /// Rotational stiffness, N.m/rad.
        stiffness: f64,
        /// Greatest rotational stiffness that the damping bears, N.m/rad.
        bearable: f64,
        /// Whether the passivity controller is there to make up for it.
        controlled: bool,
    },
    /// Law `blended`: a face that lies flat turns as stiffly as `2 F L^2 / delta`, which needs `delta > F L^2 T / b`.
    BlendDepth {
        /// Depth over which contacts fade, metres.
        blend_depth: f64,
        /// Least depth that the rotational damping bears, metres.
        needed: f64,
    },
}

impl fmt::Display for StabilityFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rest = |controlled: bool| {
            if controlled {
                "the passivity controller has to make up for it"
            } else {
                "the contact will hum or run away"
            }
        };
        match *self {
            Self::Stiffness { stiffness, bearable, controlled } => write!(
                f,
                "gains.stiffness = {stiffness} N/m: at this rate, delay and damping {bearable:.0} N/m is the bound; {}",
                rest(controlled)
            ),
            Self::RotationStiffness { stiffness, bearable, controlled } => write!(
                f,
                "gains.rotation_stiffness = {stiffness} N.m/rad: at this rate, delay and damping {bearable:.3} N.m/rad is \
                 the bound; {}",
                rest(controlled)
            ),
            Self::BlendDepth { blend_depth, needed } => write!(
                f,
                "gains.blend_depth = {blend_depth} m: a face lying flat will hum, {needed:.1e} m is the bound at this rate, \
                 greatest force and rotational damping"
            ),
        }
    }
}

/// The bounds that a configuration does not keep, for a part of which contact points are at most `lever` metres from its
/// origin. Damping is that of device and hand (`stability.*`); virtual damping counts against it, as Colgate and Schenkel
/// have it: it comes late like the stiffness.
#[must_use]
pub fn stability_findings(config: &Config, lever: f64) -> Vec<StabilityFinding> {
    let (g, s) = (&config.gains, &config.stability);
    let period = config.realtime.period();
    let hold = 0.5 * period + s.delay;
    let mut findings = Vec::new();
    let bearable = (s.damping - g.damping).max(0.0) / hold;
    if g.stiffness > bearable {
        findings.push(StabilityFinding::Stiffness { stiffness: g.stiffness, bearable, controlled: g.passivity });
    }
    let bearable = (s.rotation_damping - g.rotation_damping).max(0.0) / hold;
    // Without a rotational proxy the torque follows the force: its stiffness is that of the translation at the lever.
    if g.law == LawKind::Proxy && g.rotation_stiffness > bearable {
        findings.push(StabilityFinding::RotationStiffness {
            stiffness: g.rotation_stiffness,
            bearable,
            controlled: g.passivity,
        });
    }
    if g.law == LawKind::Blended {
        let needed = g.max_force * lever * lever * period / (s.rotation_damping + g.rotation_damping);
        if g.blend_depth < needed {
            findings.push(StabilityFinding::BlendDepth { blend_depth: g.blend_depth, needed });
        }
    }
    findings
}

/// The check at start, as `stability.check` wants it: what to warn of.
///
/// # Errors
/// The first bound that is not kept, if the policy is to refuse.
pub fn check_stability(config: &Config, scene: &Scene) -> Result<Vec<StabilityFinding>, StabilityFinding> {
    let lever = scene.world.moving.iter().flat_map(|p| p.vertices()).map(|v| v.length()).fold(0.0, f64::max);
    let findings = stability_findings(config, lever);
    match (config.stability.check, findings.first()) {
        (StabilityPolicy::Off, _) => Ok(Vec::new()),
        (StabilityPolicy::Refuse, Some(first)) => Err(*first),
        _ => Ok(findings),
    }
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
        match found[0] {
            StabilityFinding::Stiffness { bearable, .. } => bearable,
            _ => panic!("{found:?}"),
        }
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
        assert!(matches!(stability_findings(&c, 0.03)[..], [StabilityFinding::Stiffness { bearable, .. }]
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
        let found = stability_findings(&c, 0.03);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|f| f.to_string().lines().count() == 1 && f.to_string().contains("gains.")));
    }
}
