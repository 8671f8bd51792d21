use crate::coupling::passivity::HOLD_MARGIN;
use crate::low_pass_share;
use nalgebra::{Complex, Matrix2, Matrix3, RowVector2, Vector2};
use std::f64::consts::PI;

/// Frequencies looked at, for each period of the loop's delay.
const GRID: usize = 4000;
/// The lowest one, as a share of half the sampling rate.
const LOWEST: f64 = 1e-4;

/// What part of the largest stable stiffness still gives the hand no energy under the controller: nearer to the limit the
/// contact rings, and the damping of the hand pays for it.
const GAIN_MARGIN: f64 = 0.6;

/// A sampled and held spring and damper against the mass that holds it, in one degree of freedom: translation (kg, N.s/m,
/// N/m) or rotation (kg.m^2, N.m.s/rad, N.m/rad).
///
/// Says exactly where the loop turns unstable: the mass is integrated between samples, not approximated, and the
/// stiffness at which a root of the discrete characteristic equation meets the unit circle is found by walking along
/// that circle (the D-decomposition of Neimark; for haptics Diolaiti, Niemeyer, Barbagli and Salisbury 2006).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledLoop {
    /// Mass of device and hand.
    pub mass: f64,
    /// Damping of device and hand.
    pub damping: f64,
    /// Stiffness with which the hand holds on to where it wants to be.
    pub grip: f64,
    /// Time between samples, over which the wrench is held, s.
    pub period: f64,
    /// Delay between measuring and showing beyond that, s.
    pub delay: f64,
    /// Corner frequency of the velocity estimate behind the virtual damping, Hz.
    pub cutoff: f64,
}

/// The passivity controller as the loop sees it: damping `K (T/2 + t_d)`, and a fifth more, of the motion between two samples, up
/// to a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoldDamping {
    /// The limit, in the unit of damping.
    pub max: f64,
}

impl SampledLoop {
    /// The largest stiffness, from zero on, at which the loop still comes to rest under virtual damping `damping` and, if
    /// there is one, the passivity controller. Zero if the virtual damping alone is too much; infinite if there is no bound.
    #[must_use]
    pub fn largest_stiffness(&self, damping: f64, controller: Option<HoldDamping>) -> f64 {
        if damping >= self.largest_damping() {
            return 0.0;
        }
        let virtual_damping = |z: Complex<f64>| self.filtered_rate(z) * damping;
        let unity = |_: Complex<f64>| Complex::from(1.0);
        let Some(HoldDamping { max }) = controller else {
            return self.first_crossing(virtual_damping, unity, 0.0);
        };
        let late = HOLD_MARGIN * (0.5 * self.period + self.delay);
        let following = self.first_crossing(virtual_damping, |z| Complex::from(1.0) + self.rate(z) * late, 0.0);
        let full = max / late;
        if following <= full {
            return following;
        }
        self.first_crossing(|z| virtual_damping(z) + self.rate(z) * max, unity, full)
    }

    /// The largest stiffness up to which the controller keeps the hand from being given energy: its damping is not cut off, and
    /// the loop is well within stability.
    #[must_use]
    pub fn largest_passive_stiffness(&self, damping: f64, controller: HoldDamping) -> f64 {
        let uncut = controller.max / (HOLD_MARGIN * (0.5 * self.period + self.delay));
        uncut.min(GAIN_MARGIN * self.largest_stiffness(damping, Some(controller)))
    }

    /// The largest virtual damping at which the loop comes to rest without any spring.
    #[must_use]
    pub fn largest_damping(&self) -> f64 {
        self.first_crossing(|_| Complex::from(0.0), |z| self.filtered_rate(z), 0.0)
    }

    /// Finite difference of the position over a period, 1/s.
    fn rate(&self, z: Complex<f64>) -> Complex<f64> {
        (Complex::from(1.0) - z.inv()) / self.period
    }

    /// The same, low-passed.
    fn filtered_rate(&self, z: Complex<f64>) -> Complex<f64> {
        let share = low_pass_share(self.cutoff, self.period);
        self.rate(z) * share / (Complex::from(1.0) - z.inv() * (1.0 - share))
    }

    /// The smallest gain `k > above` at which `1 + P(z) (fixed(z) + k scaled(z))` vanishes somewhere on the unit circle,
    /// where P is the position's answer to the held and delayed wrench.
    fn first_crossing(
        &self,
        fixed: impl Fn(Complex<f64>) -> Complex<f64>,
        scaled: impl Fn(Complex<f64>) -> Complex<f64>,
        above: f64,
    ) -> f64 {
        let plant = Plant::new(self);
        let gain = |angle: f64| {
            let z = Complex::from_polar(1.0, angle);
            let p = plant.position(z);
            -(Complex::from(1.0) + p * fixed(z)) / (p * scaled(z))
        };
        let mut least = f64::INFINITY;
        let mut note = |k: f64| {
            if k > above && k < least {
                least = k;
            }
        };
        // At the Nyquist frequency everything is real.
        note(gain(PI).re);
        let points = GRID * (1 + (self.delay / self.period) as usize);
        let angle = |i: usize| PI * LOWEST.powf(1.0 - i as f64 / points as f64);
        let (mut from, mut at_from) = (angle(0), gain(angle(0)).im);
        for i in 1..points {
            let to = angle(i);
            let at_to = gain(to).im;
            if at_from * at_to < 0.0 {
                let (mut low, mut high) = (from, to);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if gain(middle).im * at_from > 0.0 { low = middle } else { high = middle }
                }
                note(gain(low).re);
            }
            (from, at_from) = (to, at_to);
        }
        least
    }
}

/// Position after position under a wrench held over each period: `x' = step x + late u_before + soon u`, `u` that of
/// `whole` periods ago.
struct Plant {
    step: Matrix2<f64>,
    late: Vector2<f64>,
    soon: Vector2<f64>,
    whole: i32,
}

impl Plant {
    fn new(l: &SampledLoop) -> Self {
        let whole = (l.delay / l.period).floor();
        let part = l.delay - whole * l.period;
        let (rest, pushed) = motion(l, l.period - part);
        let (_, before) = motion(l, part);
        let (step, _) = motion(l, l.period);
        Self { step, late: rest * before, soon: pushed, whole: whole as i32 }
    }

    fn position(&self, z: Complex<f64>) -> Complex<f64> {
        let input = self.soon.map(Complex::from) + self.late.map(|x| z.inv() * x);
        // (z 1 - step)^-1 by its cofactors.
        let a = self.step.map(|x| -Complex::from(x)) + Matrix2::from_diagonal_element(z);
        let determinant = a.determinant();
        let row = RowVector2::new(a[(1, 1)], -a[(0, 1)]);
        (row * input)[0] / determinant * z.powi(-self.whole)
    }
}

/// Transition of (position, velocity) over `time`, and what a unit wrench held over it does.
fn motion(l: &SampledLoop, time: f64) -> (Matrix2<f64>, Vector2<f64>) {
    let rates = Matrix3::new(0.0, 1.0, 0.0, -l.grip / l.mass, -l.damping / l.mass, 1.0 / l.mass, 0.0, 0.0, 0.0);
    let m = (rates * time).exp();
    (m.fixed_view::<2, 2>(0, 0).into_owned(), m.fixed_view::<2, 1>(0, 2).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HAND: SampledLoop =
        SampledLoop { mass: 0.3, damping: 2.0, grip: 300.0, period: 1e-3, delay: 0.0, cutoff: 150.0 };

    /// Whether the loop comes to rest, by stepping through it in `FINE` parts of a period.
    fn comes_to_rest(l: &SampledLoop, stiffness: f64, damping: f64, controller: Option<HoldDamping>) -> bool {
        const FINE: usize = 20;
        let late = (l.delay / l.period * FINE as f64).round() as usize;
        let (step, push) = motion(l, l.period / FINE as f64);
        let mut state = Vector2::new(1e-3, 0.0);
        let (mut last, mut filtered, mut wrenches) = (1e-3, 0.0, vec![0.0; late]);
        let added = controller.map_or(0.0, |c| c.max.min(HOLD_MARGIN * stiffness * (0.5 * l.period + l.delay)));
        let periods = (2.0 / l.period) as usize;
        // Of the second and the last fifth.
        let mut swing = [0.0f64; 5];
        for i in 0..periods {
            let rate = (state[0] - last) / l.period;
            last = state[0];
            filtered += (rate - filtered) * low_pass_share(l.cutoff, l.period);
            let force = -stiffness * last - damping * filtered - added * rate;
            wrenches.extend([force; FINE]);
            for j in 0..FINE {
                state = step * state + push * wrenches[i * FINE + j];
            }
            let part = &mut swing[i * 5 / periods];
            *part = part.max(state[0].abs());
        }
        swing[4] < swing[1] || swing[1] < 1e-9
    }

    fn found(l: &SampledLoop, damping: f64, controller: Option<HoldDamping>) -> f64 {
        let (mut low, mut high) = (10.0f64, 1e6f64);
        while high / low > 1.003 {
            let middle = (low * high).sqrt();
            if comes_to_rest(l, middle, damping, controller) { low = middle } else { high = middle }
        }
        low
    }

    #[test]
    fn the_loop_turns_unstable_where_it_is_said_to() {
        for period in [0.25e-3, 1e-3, 2e-3] {
            for delay in [0.0, 0.3, 1.0, 2.6] {
                for damping in [0.0, 1.0] {
                    for controller in [None, Some(HoldDamping { max: 10.0 })] {
                        let l = SampledLoop { period, delay: delay * period, ..HAND };
                        let (said, is) = (l.largest_stiffness(damping, controller), found(&l, damping, controller));
                        assert!((said / is - 1.0).abs() < 0.01, "{l:?} {damping} {controller:?}: {said}, is {is} N/m");
                    }
                }
            }
        }
    }

    #[test]
    fn a_heavy_hand_meets_the_bound_of_colgate_and_schenkel() {
        let l = SampledLoop { mass: 30.0, grip: 0.0, delay: 0.4e-3, ..HAND };
        let bound = l.damping / (0.5 * l.period + l.delay);
        assert!((l.largest_stiffness(0.0, None) / bound - 1.0).abs() < 1e-2);
    }

    #[test]
    fn too_much_virtual_damping_needs_no_spring_to_run_away() {
        // A free mass under a damper of last period's rate: 2 m / T.
        let l = SampledLoop { damping: 0.0, grip: 0.0, cutoff: 1e9, ..HAND };
        let largest = l.largest_damping();
        assert!((largest / (2.0 * l.mass / l.period) - 1.0).abs() < 1e-3, "{largest}");
        assert_eq!(l.largest_stiffness(1.01 * largest, None), 0.0);
        assert!(l.largest_stiffness(0.9 * largest, None) > 0.0);
    }
}
