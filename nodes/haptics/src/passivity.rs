use crate::Gains;
use crate::limiter::limit_factor;
use spatial::{DVec3, Wrench};

/// The most that the account of the local contact may hold, J: dissipation of long ago does not pay for energy now.
const SURPLUS: f64 = 1e-6;
/// The most that the account of the remote side may hold, J: what the hand stored there may come back.
const REMOTE_SURPLUS: f64 = 1.0;

/// How the controller may act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassivityLimits {
    /// Greatest damping it adds, N.s/m.
    pub max_damping: f64,
    /// Lever by which rotation is weighed against translation, metres.
    pub lever: f64,
    /// Energy owed beyond which it cannot keep up, J.
    pub budget: f64,
}

/// Motion of the hand during one tick: metres and rotation vector, axes of W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Metres.
    pub linear: DVec3,
    /// Rad.
    pub angular: DVec3,
}

/// Passivity observer and controller in the time domain (Hannaford and Ryu 2002), translation and rotation in one account.
///
/// The account of the contact is what the hand has put in, less what the coupling still holds: it must not fall below
/// zero. That is sharper than asking only that no net energy comes out, and makes the loss of a sampled spring, `k/2` of
/// each step squared, visible at once: the controller then adds `k T / 2` of damping, the bound of Colgate and Schenkel
/// (1997). A change of the stored energy that no motion made (re-seeding, other gains) stands in the account as
/// `k/2 (f_old^2 - f_new^2)`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Passivity {
    account: f64,
    remote: f64,
    stored: f64,
    /// Shown during the last tick: by the contact, and by the remote side.
    local_wrench: Wrench,
    remote_wrench: Wrench,
}

impl Passivity {
    /// Books a tick: the hand moved by `moved` against the wrench shown since the last tick, and the coupling now holds
    /// `stored` J, of which `ramped` J came or went by the ramp and not by the hand.
    pub fn observe(&mut self, moved: &Displacement, stored: f64, ramped: f64, limits: &PassivityLimits) {
        self.account -= work(&self.local_wrench, moved) + (stored - self.stored - ramped);
        self.remote -= work(&self.remote_wrench, moved);
        self.account = self.account.clamp(-limits.budget, SURPLUS);
        self.remote = self.remote.clamp(-limits.budget, REMOTE_SURPLUS);
        self.stored = stored;
    }

    /// Energy owed by the loop, J, `>= 0`.
    #[must_use]
    pub fn owed(&self) -> f64 {
        (-self.account).max(0.0) + (-self.remote).max(0.0)
    }

    /// The account, J: `< 0` when the loop has given energy to the hand.
    #[must_use]
    pub fn energy(&self) -> f64 {
        if self.owed() > 0.0 { -self.owed() } else { self.account }
    }

    /// The damping wrench that pays within a tick of `dt` seconds, at the rate of `moved`, what is owed and what a spring
    /// of `stiffness` (N/m, 0 when free) and `rotation_stiffness` (N.m/rad) loses by being held over that tick, as far
    /// as `limits` let it.
    #[must_use]
    pub fn control(
        &self,
        moved: &Displacement,
        (stiffness, rotation_stiffness): (f64, f64),
        dt: f64,
        limits: &PassivityLimits,
    ) -> Wrench {
        let (v, w) = (moved.linear / dt, moved.angular / dt);
        let lever2 = limits.lever * limits.lever;
        let square = v.length_squared() + lever2 * w.length_squared();
        let coming = stiffness * moved.linear.length_squared() + rotation_stiffness * moved.angular.length_squared();
        let owed = self.owed() + 0.5 * coming;
        if owed <= 0.0 || square <= 0.0 {
            return Wrench::ZERO;
        }
        let damping = (owed / (dt * square)).min(limits.max_damping);
        Wrench::new(v * -damping, w * (-damping * lever2))
    }

    /// Takes note of what is shown during the coming tick: the contact's part and the remote side's.
    pub fn shown(&mut self, local: Wrench, remote: Wrench) {
        self.local_wrench = local;
        self.remote_wrench = remote;
    }

    /// Whether the controller cannot keep up: the budget is used up.
    #[must_use]
    pub fn exhausted(&self, limits: &PassivityLimits) -> bool {
        self.account <= -limits.budget || self.remote <= -limits.budget
    }

    /// Closes the account.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

fn work(wrench: &Wrench, moved: &Displacement) -> f64 {
    wrench.force.dot(moved.linear) + wrench.torque.dot(moved.angular)
}

/// What the coupling holds as the hand can get it back, J: where the limiter cuts a spring's force to the share `r`, its
/// energy `U` counts `U (2 r - r^2)` only. `energy` is the law's, `wrench` its own wrench; force over `scale` motion.
#[must_use]
pub fn returnable_energy(energy: f64, wrench: &Wrench, gains: &Gains, scale: f64) -> f64 {
    let force = wrench.force.length();
    let of_force = (0.5 * force * force / gains.stiffness).min(energy);
    let cut = |r: f64| r * (2.0 - r);
    let r_force = limit_factor(force, gains.max_force);
    let r_torque = limit_factor(wrench.torque.length(), gains.max_torque);
    of_force * cut(r_force) / scale + (energy - of_force) * cut(r_torque)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMITS: PassivityLimits = PassivityLimits { max_damping: 50.0, lever: 0.03, budget: 1e-2 };
    const K: f64 = 1000.0;
    const DT: f64 = 1e-3;

    /// A mass on a sampled wall: greatest energy that came out of the wall, J, and the mass's last speed.
    fn bounce(mass: f64, speed: f64, controlled: bool) -> (f64, f64) {
        let mut p = Passivity::default();
        let (mut z, mut v) = (1e-3, -speed);
        let (mut given, mut most) = (0.0f64, 0.0f64);
        let mut last_z = z;
        for _ in 0..3000 {
            let depth = f64::max(0.0, -z);
            let moved = Displacement { linear: DVec3::Z * (z - last_z), angular: DVec3::ZERO };
            last_z = z;
            p.observe(&moved, 0.5 * K * depth * depth, 0.0, &LIMITS);
            let damping = if controlled {
                p.control(&moved, (if depth > 0.0 { K } else { 0.0 }, 0.0), DT, &LIMITS)
            } else {
                Wrench::ZERO
            };
            let out = Wrench::new(DVec3::Z * (K * depth) + damping.force, DVec3::ZERO);
            p.shown(out, Wrench::ZERO);
            for _ in 0..50 {
                let dt = DT / 50.0;
                v += out.force.z / mass * dt;
                z += v * dt;
                given += out.force.z * v * dt;
            }
            most = most.max(given);
        }
        (most, v)
    }

    #[test]
    fn a_sampled_wall_gives_energy_and_the_controller_takes_it_back() {
        for (mass, speed) in [(0.05, 0.2), (0.1, 0.5), (0.5, 0.3)] {
            let (free, v_free) = bounce(mass, speed, false);
            let (held, v_held) = bounce(mass, speed, true);
            assert!(free > 1e-4 && v_free > speed, "the wall alone is active: {free} J");
            assert!(v_held <= speed * (1.0 + 1e-3), "{v_held} after {speed}");
            assert!(held < 0.05 * free, "{held} of {free} J");
        }
    }

    #[test]
    fn a_change_of_stiffness_in_contact_is_owed() {
        let mut p = Passivity::default();
        let still = Displacement::default();
        p.observe(&still, 0.0, 0.0, &LIMITS);
        p.observe(&still, 1e-3, 0.0, &LIMITS);
        assert!((p.owed() - 1e-3).abs() < 1e-15);
        // By the ramp it is not: the hand asked for force.
        let mut p = Passivity::default();
        p.observe(&still, 1e-3, 1e-3, &LIMITS);
        assert_eq!(p.owed(), 0.0);
    }

    proptest! {
        #[test]
        fn a_slow_closed_loop_on_a_spring_owes_nothing_beyond_its_steps(n in 2000u32..5000, depth in 1e-4..5e-3) {
            let mut p = Passivity::default();
            let mut owed = 0.0f64;
            let (mut last, mut steps) = (0.0, 0.0);
            for i in 0..=n {
                let z = depth * 0.5 * (1.0 - (std::f64::consts::TAU * f64::from(i) / f64::from(n)).cos());
                let moved = Displacement { linear: DVec3::NEG_Z * (z - last), angular: DVec3::ZERO };
                steps += 0.5 * K * (z - last) * (z - last);
                last = z;
                p.observe(&moved, 0.5 * K * z * z, 0.0, &LIMITS);
                p.shown(Wrench::new(DVec3::Z * (K * z), DVec3::ZERO), Wrench::ZERO);
                owed = owed.max(p.owed());
            }
            prop_assert!((owed - steps).abs() < 1e-9 * depth * depth * K + 1e-15, "{owed} {steps}");
        }

        #[test]
        fn the_controller_only_takes(x in -1.0..1.0, y in -1.0..1.0, w in -1.0..1.0, owed in 0.0..1.0) {
            let mut p = Passivity::default();
            p.observe(&Displacement::default(), owed, 0.0, &PassivityLimits { budget: 10.0, ..LIMITS });
            let moved = Displacement { linear: DVec3::new(x, y, 0.0) * 1e-3, angular: DVec3::Z * w * 1e-2 };
            let wrench = p.control(&moved, (0.0, 0.0), DT, &LIMITS);
            let taken = -work(&wrench, &moved);
            prop_assert!(taken >= 0.0 && taken <= owed * (1.0 + 1e-9));
        }

        #[test]
        fn a_cut_springs_energy_is_the_work_to_let_it_go(stretch in 1e-5..0.1, max in 0.1..20.0) {
            let gains = Gains { stiffness: K, max_force: max, ..Default::default() };
            let wrench = Wrench::new(DVec3::X * (K * stretch), DVec3::ZERO);
            let energy = returnable_energy(0.5 * K * stretch * stretch, &wrench, &gains, 1.0);
            let n = 20_000;
            let work: f64 = (0..n).map(|i| {
                let s = stretch * (f64::from(i) + 0.5) / f64::from(n);
                f64::min(K * s, max) * stretch / f64::from(n)
            }).sum();
            prop_assert!((energy - work).abs() < 1e-6 * work);
        }
    }
}
