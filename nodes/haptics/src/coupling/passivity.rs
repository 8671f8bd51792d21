use crate::Gains;
use crate::coupling::limiter::limit_factor;
use spatial::{DVec3, Wrench};

/// The most that the account of the local contact may hold, J: dissipation of long ago does not pay for energy now.
const SURPLUS: f64 = 1e-6;
/// The most that the account of the remote side may hold, J: what the hand stored there may come back.
const REMOTE_SURPLUS: f64 = 1.0;

/// How much more than `k (T/2 + t_d)`, which a slow motion asks, the controller damps: the damping comes a half period later
/// than the spring, so that at the loop's own frequency a part of it acts as a spring.
pub(crate) const HOLD_MARGIN: f64 = 1.2;

/// Wrenches that may be on their way to the hand: a longer delay than so many ticks, less two, is booked as this one.
const ON_THE_WAY: usize = 16;

/// How the controller may act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassivityLimits {
    /// Greatest damping it adds, N.s/m.
    pub max_damping: f64,
    /// Lever by which rotation is weighed against translation, metres.
    pub lever: f64,
    /// Energy given to the hand beyond what it has put in at which it cannot keep up, J.
    pub budget: f64,
    /// Delay between measuring and showing beyond the hold of a tick, s.
    pub delay: f64,
    /// Mass of device and hand, kg: how far a force moves them within a tick.
    pub mass: f64,
    /// Moment of inertia of device and hand, kg.m^2.
    pub inertia: f64,
}

/// Motion of the hand during one tick: metres and rotation vector, axes of W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Metres.
    pub linear: DVec3,
    /// Rad.
    pub angular: DVec3,
}

/// What the coupling holds, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Held {
    /// Energy that the hand can get back.
    pub stored: f64,
    /// How much of its change came or went by the ramp and not by the hand.
    pub ramped: f64,
    /// A loss that one step of the encoders may feign: `k/2` of it squared. A hand that rests on the edge between two steps
    /// would else be booked as giving and getting that much again and again.
    pub unsure: f64,
}

/// Passivity observer and controller in the time domain (Hannaford and Ryu 2002), translation and rotation in one account.
///
/// The account of the contact is what the hand has put in, less what the coupling still holds: it must not fall below
/// zero. That is sharper than asking only that no net energy comes out, and makes the loss of a sampled spring, `k/2` of
/// each step squared, visible at once: the controller adds `k (T/2 + t_d)` of damping and a fifth more, the bound of Colgate
/// and Schenkel (1997) with the delay. Where that comes too late, as in a wall that is only a tick or two thick for a
/// fast hand, no more is shown than what the hand has put in pays for ([`Passivity::affordable`]). A change of the
/// stored energy that no motion made (re-seeding, other gains) stands in the account as `k/2 (f_old^2 - f_new^2)`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Passivity {
    account: f64,
    remote: f64,
    stored: f64,
    /// Shown by the contact and by the remote side: a ring, newest first from `newest` on.
    shown: [(Wrench, Wrench); ON_THE_WAY],
    newest: usize,
}

impl Passivity {
    /// Books a tick of `dt` seconds: the hand moved by `moved` against the wrench that reached it meanwhile, and this is what
    /// the coupling now holds.
    pub fn observe(&mut self, moved: &Displacement, held: &Held, dt: f64, limits: &PassivityLimits) {
        let (local, remote) = self.felt(limits.delay / dt);
        let loss = work(&local, moved) + (held.stored - self.stored - held.ramped);
        self.account -= if loss > 0.0 { (loss - held.unsure).max(0.0) } else { loss };
        self.remote -= work(&remote, moved);
        // What the coupling holds without having been paid for stays owed until it is let go of: forgiven, it would go to the hand.
        self.account = self.account.clamp(-limits.budget - held.stored, SURPLUS);
        self.remote = self.remote.clamp(-limits.budget, REMOTE_SURPLUS);
        self.stored = held.stored;
    }

    /// What the hand felt during the last tick, on average, if it comes `ticks` late.
    fn felt(&self, ticks: f64) -> (Wrench, Wrench) {
        let ticks = ticks.clamp(0.0, (ON_THE_WAY - 2) as f64);
        let (whole, part) = (ticks as usize, ticks.fract());
        let (new, old) = (self.shown_before(whole), self.shown_before(whole + 1));
        let mean = |new: Wrench, old: Wrench| new * (1.0 - part) + old * part;
        (mean(new.0, old.0), mean(new.1, old.1))
    }

    /// Energy owed by the loop, J, `>= 0`.
    #[must_use]
    pub fn owed(&self) -> f64 {
        (-self.account).max(0.0) + (-self.remote).max(0.0)
    }

    /// The account, J: what the hand has put in, less what the coupling holds. `< 0` is owed: it would be given to the hand if it
    /// were let go of as it is.
    #[must_use]
    pub fn energy(&self) -> f64 {
        if self.owed() > 0.0 { -self.owed() } else { self.account }
    }

    /// The damping wrench at the rate of `moved`, the hand's motion in a tick of `dt` seconds, as far as `limits` let it. It
    /// pays what a spring of `stiffness` (N/m, 0 when free) and `rotation_stiffness` (N.m/rad) loses by being held over
    /// the tick and by coming late, each in its own motion, and in a tick what is owed, in both.
    #[must_use]
    pub fn control(
        &self,
        moved: &Displacement,
        (stiffness, rotation_stiffness): (f64, f64),
        dt: f64,
        limits: &PassivityLimits,
    ) -> Wrench {
        let rate = 1.0 / dt;
        let (v, w) = (moved.linear * rate, moved.angular * rate);
        let lever2 = limits.lever * limits.lever;
        let square = v.length_squared() + lever2 * w.length_squared();
        let paying = if square > 0.0 { self.owed() / (dt * square) } else { 0.0 };
        let late = 0.5 * dt + limits.delay;
        // In contact no more for what is owed than for the hold: an encoder step must not be answered by a blow.
        let in_contact = stiffness > 0.0;
        let damping = |held: f64| {
            let paying = if in_contact { paying.min(held) } else { paying };
            (held + paying).min(limits.max_damping)
        };
        let late = HOLD_MARGIN * late;
        let rotation_damping = damping(rotation_stiffness * late / lever2) * lever2;
        let damping = damping(stiffness * late);
        Wrench::new(v * -damping, w * -rotation_damping)
    }

    /// The share, 0 to 1, of the local `wrench` that may be shown over a tick of `dt` seconds, in which the hand would move by
    /// `moving` at its present rate: what the wrench would do to a hand that is on its way out must have been put in before.
    /// 1 for a hand on its way in, and where there is enough.
    #[must_use]
    pub fn affordable(&self, wrench: &Wrench, moving: &Displacement, dt: f64, limits: &PassivityLimits) -> f64 {
        let flow = work(wrench, moving);
        if flow <= 0.0 {
            return 1.0;
        }
        // What is on its way to the hand is spent first.
        let ticks = (limits.delay / dt).clamp(0.0, (ON_THE_WAY - 2) as f64);
        let whole = ticks as usize;
        let mut coming = work(&self.shown_before(whole).0, moving) * ticks.fract();
        for ago in 0..whole {
            coming += work(&self.shown_before(ago).0, moving);
        }
        let have = (self.stored + self.account - coming.max(0.0)).max(0.0);
        // The wrench speeds the hand up meanwhile; not so while it only turns round.
        let push = wrench.force.length_squared() / limits.mass + wrench.torque.length_squared() / limits.inertia;
        let push = push * dt * (dt + limits.delay);
        let push = push * flow / (flow + push);
        if flow + push <= have {
            return 1.0;
        }
        // share flow + share^2 push = have
        2.0 * have / (flow + (flow * flow + 4.0 * push * have).sqrt())
    }

    /// Takes note of what is shown during the coming tick: the contact's part and the remote side's.
    pub fn shown(&mut self, local: Wrench, remote: Wrench) {
        self.newest = (self.newest + ON_THE_WAY - 1) % ON_THE_WAY;
        self.shown[self.newest] = (local, remote);
    }

    /// What was shown `ago` ticks before the newest.
    fn shown_before(&self, ago: usize) -> (Wrench, Wrench) {
        self.shown[(self.newest + ago) % ON_THE_WAY]
    }

    /// Whether the controller cannot keep up: the hand has got more than it has put in, by the whole budget.
    #[must_use]
    pub fn exhausted(&self, limits: &PassivityLimits) -> bool {
        self.stored + self.account <= -limits.budget || self.remote <= -limits.budget
    }

    /// Closes the account.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

fn work(wrench: &Wrench, moved: &Displacement) -> f64 {
    wrench.force.dot(moved.linear) + wrench.torque.dot(moved.angular)
}

/// What the coupling holds as the hand can get it back, J, while only `share` of the wrench is shown: where the limiter cuts a
/// spring's force to the part `r`, its energy `U` counts `U (2 r - r^2)` only. `energy` is the law's, `wrench` its own wrench;
/// force over `scale` motion.
#[must_use]
pub fn returnable_energy(energy: f64, wrench: &Wrench, share: f64, gains: &Gains, scale: f64) -> f64 {
    let force = wrench.force.length_squared();
    let of_force = (0.5 * force / gains.stiffness).min(energy);
    let cut = |r: f64| r * (2.0 - r);
    let r_force = limit_factor(share * share * force, gains.max_force);
    let r_torque = limit_factor(share * share * wrench.torque.length_squared(), gains.max_torque);
    share * (of_force * cut(r_force) / scale + (energy - of_force) * cut(r_torque))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMITS: PassivityLimits =
        PassivityLimits { max_damping: 50.0, lever: 0.03, budget: 1e-2, delay: 0.0, mass: 0.1, inertia: 1e-4 };
    const K: f64 = 1000.0;
    const DT: f64 = 1e-3;

    fn held(stored: f64) -> Held {
        Held { stored, ..Held::default() }
    }

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
            p.observe(&moved, &held(0.5 * K * depth * depth), DT, &LIMITS);
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
        p.observe(&still, &held(0.0), DT, &LIMITS);
        p.observe(&still, &held(1e-3), DT, &LIMITS);
        assert!((p.owed() - 1e-3).abs() < 1e-15);
        // By the ramp it is not: the hand asked for force.
        let mut p = Passivity::default();
        p.observe(&still, &Held { ramped: 1e-3, ..held(1e-3) }, DT, &LIMITS);
        assert_eq!(p.owed(), 0.0);
    }

    #[test]
    fn what_is_stored_unpaid_stays_owed_beyond_the_budget() {
        let mut p = Passivity::default();
        let still = Displacement::default();
        p.observe(&still, &held(0.5), DT, &LIMITS);
        assert_eq!((p.owed(), p.exhausted(&LIMITS)), (0.5, false), "the hand has got nothing yet");
        let spring = Wrench::new(DVec3::Z, DVec3::ZERO);
        let out = Displacement { linear: DVec3::Z * 1e-3, angular: DVec3::ZERO };
        assert_eq!(p.affordable(&spring, &out, DT, &LIMITS), 0.0);
        p.observe(&still, &held(0.0), DT, &LIMITS);
        assert_eq!(p.owed(), 0.0, "let go of");
        p.shown(spring, Wrench::ZERO);
        p.observe(&Displacement { linear: DVec3::Z, ..still }, &held(0.0), DT, &LIMITS);
        assert!(p.owed() == LIMITS.budget && p.exhausted(&LIMITS), "the hand has got it");
    }

    #[test]
    fn wrenches_are_booked_when_they_are_felt() {
        let late = PassivityLimits { delay: 1.5 * DT, ..LIMITS };
        let mut p = Passivity::default();
        let push = Wrench::new(DVec3::X, DVec3::ZERO);
        let moved = Displacement { linear: DVec3::X * 1e-3, angular: DVec3::ZERO };
        let mut owed = Vec::new();
        for _ in 0..4 {
            p.observe(&moved, &held(0.0), DT, &late);
            owed.push((p.owed() * 1e6).round() as i64);
            p.shown(push, Wrench::ZERO);
        }
        // Shown at the first tick: half of it is felt in the third.
        assert_eq!(owed, [0, 0, 500, 1500]);
    }

    #[test]
    fn no_more_is_shown_than_was_put_in() {
        let mut p = Passivity::default();
        // 0.1 mm into the wall against 0.03 N: less than the 5e-6 J that the spring then holds.
        let into = Displacement { linear: DVec3::NEG_Z * 1e-4, angular: DVec3::ZERO };
        p.shown(Wrench::new(DVec3::Z * 0.03, DVec3::ZERO), Wrench::ZERO);
        p.observe(&into, &held(0.5 * K * 1e-8), DT, &LIMITS);
        let spring = Wrench::new(DVec3::Z * (K * 1e-4), DVec3::ZERO);
        assert_eq!(p.affordable(&spring, &into, DT, &LIMITS), 1.0, "on the way in");
        let out = Displacement { linear: DVec3::Z * 2e-4, angular: DVec3::ZERO };
        let share = p.affordable(&spring, &out, DT, &LIMITS);
        let given = share * (work(&spring, &out) + share * (K * 1e-4).powi(2) / LIMITS.mass * DT * DT);
        assert!(given > 0.99 * 3e-6 && given < 1.01 * 3e-6, "{share}: {given} J of 3e-6");
        let slow = Displacement { linear: DVec3::Z * 1e-6, angular: DVec3::ZERO };
        assert_eq!(p.affordable(&spring, &slow, DT, &LIMITS), 1.0, "there is enough");
    }

    #[test]
    fn a_step_of_the_encoders_is_not_booked_as_loss() {
        let step = 1e-5;
        let mut p = Passivity::default();
        for i in 0..1000 {
            let down = i % 2 == 0;
            let depth = if down { step } else { 0.0 };
            let moved = Displacement { linear: DVec3::Z * if down { -step } else { step }, angular: DVec3::ZERO };
            let unsure = 0.5 * K * step * step;
            p.observe(&moved, &Held { unsure, ..held(0.5 * K * depth * depth) }, DT, &LIMITS);
            p.shown(Wrench::new(DVec3::Z * (K * depth), DVec3::ZERO), Wrench::ZERO);
        }
        assert!(p.owed() < 1e-15, "{}", p.owed());
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
                p.observe(&moved, &held(0.5 * K * z * z), DT, &LIMITS);
                p.shown(Wrench::new(DVec3::Z * (K * z), DVec3::ZERO), Wrench::ZERO);
                owed = owed.max(p.owed());
            }
            prop_assert!((owed - steps).abs() < 1e-9 * depth * depth * K + 1e-15, "{owed} {steps}");
        }

        #[test]
        fn the_controller_only_takes(x in -1.0..1.0, y in -1.0..1.0, w in -1.0..1.0, owed in 0.0..1.0) {
            let mut p = Passivity::default();
            p.observe(&Displacement::default(), &held(owed), DT, &PassivityLimits { budget: 10.0, ..LIMITS });
            let moved = Displacement { linear: DVec3::new(x, y, 0.0) * 1e-3, angular: DVec3::Z * w * 1e-2 };
            let wrench = p.control(&moved, (0.0, 0.0), DT, &LIMITS);
            let taken = -work(&wrench, &moved);
            prop_assert!(taken >= 0.0 && taken <= owed * (1.0 + 1e-9));
        }

        #[test]
        fn a_cut_springs_energy_is_the_work_to_let_it_go(stretch in 1e-5..0.1, max in 0.1..20.0, share in 0.1..1.0) {
            let gains = Gains { stiffness: K, max_force: max, ..Default::default() };
            let wrench = Wrench::new(DVec3::X * (K * stretch), DVec3::ZERO);
            let energy = returnable_energy(0.5 * K * stretch * stretch, &wrench, share, &gains, 1.0);
            let n = 20_000;
            let work: f64 = (0..n).map(|i| {
                let s = stretch * (f64::from(i) + 0.5) / f64::from(n);
                f64::min(share * K * s, max) * stretch / f64::from(n)
            }).sum();
            prop_assert!((energy - work).abs() < 1e-6 * work);
        }
    }
}
