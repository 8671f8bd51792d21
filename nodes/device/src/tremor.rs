use rand::RngExt;
use rand_pcg::Pcg64;
use spatial::{DVec3, Wrench};

/// Physiological tremor: a few oscillations between 8 and 12 Hz in every direction, as a force and torque on the arm.
///
/// Each oscillation is a phasor turned by a constant every step: no trigonometry in the loop, the same on every machine.
#[derive(Clone, Debug)]
pub(crate) struct Tremor {
    phasors: [Phasor; 6 * Tremor::TONES],
    force: f64,
    torque: f64,
}

#[derive(Clone, Copy, Debug)]
struct Phasor {
    cos: f64,
    sin: f64,
    step_cos: f64,
    step_sin: f64,
}

impl Tremor {
    const TONES: usize = 2;

    /// Tremor of the given amplitudes (N, N.m) that is advanced in steps of `step` seconds.
    pub(crate) fn new(rng: &mut Pcg64, force: f64, torque: f64, step: f64) -> Self {
        let phasors = std::array::from_fn(|_| {
            let omega = std::f64::consts::TAU * (8.0 + 4.0 * rng.random::<f64>());
            let (sin, cos) = (std::f64::consts::TAU * rng.random::<f64>()).sin_cos();
            let (step_sin, step_cos) = (omega * step).sin_cos();
            Phasor { cos, sin, step_cos, step_sin }
        });
        let share = 1.0 / Self::TONES as f64;
        Self { phasors, force: force * share, torque: torque * share }
    }

    /// Goes one step on and gives the tremor's wrench.
    pub(crate) fn step(&mut self) -> Wrench {
        let mut sums = [0.0; 6];
        for (n, p) in self.phasors.iter_mut().enumerate() {
            (p.cos, p.sin) = (p.cos * p.step_cos - p.sin * p.step_sin, p.sin * p.step_cos + p.cos * p.step_sin);
            sums[n % 6] += p.sin;
        }
        let [fx, fy, fz, tx, ty, tz] = sums;
        Wrench::new(DVec3::new(fx, fy, fz) * self.force, DVec3::new(tx, ty, tz) * self.torque)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn oscillates_between_8_and_12_hz_within_its_amplitude() {
        let mut tremor = Tremor::new(&mut Pcg64::seed_from_u64(3), 0.5, 0.01, 1e-4);
        let (mut crossings, mut last, mut most) = (0, 0.0, 0.0f64);
        for _ in 0..100_000 {
            let w = tremor.step();
            crossings += u32::from(w.force.x * last < 0.0);
            last = w.force.x;
            most = most.max(w.force.abs().max_element());
            assert!(w.torque.abs().max_element() <= 0.01 + 1e-9);
        }
        // 10 s: 8 to 12 Hz cross zero 160 to 240 times.
        assert!((160..=240).contains(&crossings), "{crossings}");
        assert!(most > 0.2 && most <= 0.5 + 1e-9, "{most}");
    }
}
