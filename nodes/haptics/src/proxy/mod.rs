//! The proxy: the pose nearest to the hand's in the coupling's metric that penetrates nothing, followed from tick to tick.
//!
//! After Zilles and Salisbury 1995 and Ortega, Redon and Coquillart 2007. The constraints are the basic contacts of the
//! contact regions in reach, not all C-faces: those are alternatives, and together they would forbid free poses.

mod friction;
mod metric;
mod safe;
mod steadying;
mod step;
mod view;

pub use friction::Coefficients;
pub(crate) use friction::Friction;

use crate::Gains;
use crate::projection::{Projection, Row};
use crate::solid::{Placed, Solids};
use metric::{Metric, contact_rows};
use safe::Safe;
use spatial::{Pose, Wrench};
use steadying::Steadying;
use step::Step;
use view::{PENETRATION, View};

/// Re-linearisations in one tick while steps are not cut short; with cut steps (fast motion), in all.
const ROUNDS: usize = 4;
const ROUNDS_FAST: usize = 16;
/// Steps below this (metres at the body's reach) are applied to the contacts seen, without looking again.
const SMALL: f64 = 1e-8;
/// Contacts with gaps larger than this many ways of the hand in the tick, and than this (metres), are looked at only when a step
/// may lead to them.
const AHEAD: f64 = 8.0;
const NEARBY: f64 = 1e-5;
/// Steps on the contacts seen once they are small, at most, and the size below which they end (metres at the body's reach).
const POLISH: usize = 3;
const VANISHING: f64 = 1e-11;
/// Most C-faces tried instead of others in one round.
const TRIES: usize = 4;
/// Another C-face is taken where the square of the way left to the hand becomes less than this part of it.
const NEARER: f64 = 1.0 - 1e-6;
/// Largest turn of one linearised step, radians.
const TURN: f64 = 0.05;

/// The proxy pose, the contacts seen there and the solver's scratch.
#[derive(Debug)]
pub(crate) struct Proxy {
    pub pose: Pose,
    pub view: View,
    rows: Vec<Row<6>>,
    projection: Projection<6>,
    friction: Friction,
    steadying: Steadying,
    last_hip: Option<Pose>,
    /// From the hand to the proxy at the end of the tick.
    stretch: Step,
    /// How far the proxy looks around in this tick, metres.
    sight: f64,
    /// Motion since the last look, metres.
    stale: f64,
}

impl Proxy {
    pub fn new(solids: &Solids, friction: Friction) -> Self {
        Self {
            pose: Pose::IDENTITY,
            view: View::new(solids),
            rows: Vec::with_capacity(View::ROOM + 16),
            projection: Projection::new(),
            friction,
            steadying: Steadying::default(),
            last_hip: None,
            stretch: Step::NONE,
            sight: f64::INFINITY,
            stale: 0.0,
        }
    }

    /// Forgets the proxy; the next pose starts it anew.
    pub fn reset(&mut self) {
        self.last_hip = None;
        self.projection = Projection::new();
        self.friction.reset();
        self.steadying.reset();
        self.view.reset();
    }

    /// Puts the proxy at `pose` and pushes it out of whatever it penetrates there.
    pub fn seed(&mut self, solids: &Solids, pose: &Pose, gains: &Gains) {
        self.pose = *pose;
        self.view.reset();
        self.friction.reset();
        self.sight = f64::INFINITY;
        self.look(solids);
        self.push_out(solids, &Metric::new(gains), 16);
    }

    /// Follows the hand for one tick. Returns true if the proxy had to be seeded anew.
    pub fn follow(&mut self, solids: &Solids, hip: &Pose, gains: &Gains, dt: f64) -> bool {
        let lever = self.view.lever;
        let moved = self.last_hip.replace(*hip).map(|last| {
            let moved = Step { dp: hip.translation - last.translation, dtheta: last.rotation_to(hip) };
            moved.way(lever)
        });
        let jumped = moved.is_none_or(|way| way > self.view.jump);
        if jumped {
            self.seed(solids, hip, gains);
        }
        let metric = Metric::new(gains);
        let rubs = self.friction.is_on(gains);
        self.friction.begin();
        self.steadying.begin();
        let (sight, mut budget) = match moved {
            // Edge rounding: the proxy may catch up with the hand at no more than the stated speed.
            Some(way) if !jumped => {
                let sight = if rubs { f64::INFINITY } else { NEARBY.max(AHEAD * way) };
                (sight, way + gains.proxy_speed.max(0.0) * dt.max(0.0))
            }
            _ => (f64::INFINITY, f64::INFINITY),
        };
        self.sight = sight;
        if self.stale > SMALL {
            self.look(solids);
        }
        let mut safe = None::<Safe>;
        let mut drag = Wrench::ZERO;
        let mut cut = 0;
        for round in 0..ROUNDS_FAST {
            if round - cut >= ROUNDS {
                break;
            }
            let to_hand = self.to_hand(hip);
            let goal = metric.pulled(&to_hand, &drag);
            let mut step = loop {
                let step = self.solve(&metric, &goal);
                let step = self.choose(solids, &metric, &goal, step);
                if self.view.is_listed(step.way(lever)) {
                    break step;
                }
                self.look_farther(solids);
            };
            self.keep_best(&mut safe, metric.energy(&to_hand), drag != Wrench::ZERO);
            if rubs {
                if drag != Wrench::ZERO {
                    step = self.solve(&metric, &to_hand);
                }
                let (metric, goal) = metric.steadied(&self.steadying, &to_hand);
                let Self { friction, view, projection, rows, pose, .. } = self;
                drag = friction.drag(view, projection, rows, &metric, &goal, pose, gains);
                let free = step;
                step = self.solve(&metric, &metric.pulled(&to_hand, &drag));
                // Places that are held in turn may push each other: together they only take.
                let (taken, given) = (free.work(&drag), step.work(&drag));
                if given > 0.0 {
                    drag = drag * (taken / (taken - given)).clamp(0.0, 1.0);
                    step = self.solve(&metric, &metric.pulled(&to_hand, &drag));
                }
            }
            let way = step.way(lever);
            let limit = self.view.reach.min(budget).min(way * TURN / step.dtheta.length().max(1e-300));
            let scale = if way > limit { limit / way } else { 1.0 };
            cut += usize::from(way > self.view.reach);
            self.steadying.learn(&step, scale, &self.projection, &self.view);
            let step = step.scaled(scale);
            budget -= way * scale;
            if scale == 1.0 && self.projection.active().next().is_none() && drag == Wrench::ZERO {
                self.pose = *hip;
            } else {
                self.pose = self.pose.moved(step.dp, step.dtheta);
            }
            if way * scale <= SMALL {
                self.view.shift(solids, &step, &self.pose);
                self.stale += way * scale;
                self.polish(solids, hip, &metric, &drag, way * scale);
                break;
            }
            self.look(solids);
            if budget <= SMALL {
                break;
            }
        }
        if self.stale > SMALL {
            self.look(solids);
        }
        if self.view.penetration > PENETRATION {
            self.push_out(solids, &metric, 4);
        }
        self.stretch = self.stretch_to(hip);
        if let Some(safe) = safe.filter(|safe| !self.is_no_worse(safe, &metric)) {
            self.back_off(solids, &safe, hip, &metric);
        }
        jumped
    }

    /// Further steps on the contacts seen, which follow to first order, until the steps vanish: the linearised program turns
    /// the forces a little with every step, and what is left undone acts like friction.
    fn polish(&mut self, solids: &Solids, hip: &Pose, metric: &Metric, drag: &Wrench, first: f64) {
        let mut last = first;
        for _ in 0..POLISH {
            if last <= VANISHING || self.stale > SMALL || self.pose == *hip {
                return;
            }
            let goal = self.goal(hip, drag, metric);
            let step = self.solve(metric, &goal);
            let way = step.way(self.view.lever);
            // Steps that do not shrink lead nowhere.
            if !(way < 0.5 * last) {
                return;
            }
            self.pose = self.pose.moved(step.dp, step.dtheta);
            self.view.shift(solids, &step, &self.pose);
            self.stale += way;
            last = way;
        }
    }

    /// Elastic pull of the coupling on the hand that was followed last: force (N) and torque (N.m), and its energy (J).
    pub fn pull(&self, gains: &Gains) -> (Wrench, f64) {
        let Step { dp, dtheta } = self.stretch;
        let wrench = Wrench::new(dp * gains.stiffness, dtheta * gains.rotation_stiffness);
        let energy = 0.5 * (gains.stiffness * dp.length_squared() + gains.rotation_stiffness * dtheta.length_squared());
        (wrench, energy)
    }

    fn look(&mut self, solids: &Solids) {
        self.view.look(solids, &self.pose, self.sight);
        self.stale = 0.0;
    }

    fn look_farther(&mut self, solids: &Solids) {
        self.sight = f64::INFINITY;
        self.look(solids);
    }

    fn stretch_to(&self, hip: &Pose) -> Step {
        Step { dp: self.pose.translation - hip.translation, dtheta: hip.rotation_to(&self.pose) }
    }

    fn to_hand(&self, hip: &Pose) -> Step {
        self.stretch_to(hip).scaled(-1.0)
    }

    /// Where the proxy would go if nothing were in its way: to the hand, but for the drag of friction.
    fn goal(&self, hip: &Pose, drag: &Wrench, metric: &Metric) -> Step {
        metric.pulled(&self.to_hand(hip), drag)
    }

    /// Remembers the pose if it is free and the best so far. After [`Proxy::solve`]; `energy` is the coupling's there, J.
    fn keep_best(&self, safe: &mut Option<Safe>, energy: f64, dragged: bool) {
        if self.view.penetration > PENETRATION {
            return;
        }
        // What it takes to come out of what counts as no penetration.
        let due = |(k, force): (usize, f64)| self.view.points.get(k).map_or(0.0, |p| force * (-p.gap).max(0.0));
        let is_clear = self.view.penetration <= VANISHING;
        let energy = energy + if is_clear { 0.0 } else { self.projection.active().map(due).sum::<f64>() };
        Safe::keep_best(safe, &self.pose, energy, dragged);
    }

    /// Whether the proxy is free and the coupling holds no more energy than it may.
    fn is_no_worse(&self, safe: &Safe, metric: &Metric) -> bool {
        self.view.penetration <= PENETRATION && metric.energy(&self.stretch) <= safe.most
    }

    fn solve(&mut self, metric: &Metric, goal: &Step) -> Step {
        let (metric, goal) = &metric.steadied(&self.steadying, goal);
        contact_rows(&mut self.rows, &self.view, &self.pose, metric, goal);
        self.projection.solve_again(&self.rows);
        metric.step(&self.projection.z, goal)
    }

    /// Where two C-faces of a pair meet at the proxy, the pair is free on the side of either: takes the one that lets the proxy
    /// come nearer to the hand. Else a part that slides flat over a gap catches on the far rim by a rounding error.
    fn choose(&mut self, solids: &Solids, metric: &Metric, goal: &Step, mut step: Step) -> Step {
        let placed = Placed::new(&self.pose);
        let (mut k, mut tries) = (0, 0);
        for _ in 0..self.view.pairs.len() {
            let of_pair = self.view.pairs[k].first..self.view.pairs[k].end;
            let holds = tries < TRIES && self.projection.active().any(|(row, _)| of_pair.contains(&row));
            let Some(plane) = holds.then(|| self.view.tied_plane(solids, k, &self.pose, &placed)).flatten() else {
                k += 1;
                continue;
            };
            tries += 1;
            let left = self.projection.way_squared();
            let old = self.view.replace_wall(solids, k, &plane, &self.pose, &placed);
            k -= old.before;
            step = self.solve(metric, goal);
            if self.projection.way_squared() > NEARER * left {
                self.view.restore(solids, &old, &placed);
                step = self.solve(metric, goal);
            }
        }
        step
    }

    /// The least motion that removes the penetration left, in up to `rounds` steps.
    fn push_out(&mut self, solids: &Solids, metric: &Metric, rounds: usize) {
        for _ in 0..rounds {
            if self.view.penetration <= PENETRATION {
                return;
            }
            let stay = Step::NONE;
            let mut step = self.solve(metric, &stay);
            if !self.view.is_listed(step.way(self.view.lever)) {
                self.look_farther(solids);
                step = self.solve(metric, &stay);
            }
            let turn = step.dtheta.length();
            // Turning far under a linear model only stirs: what the turn cannot do, the next round's translation does.
            let step = if turn > TURN { step.scaled(TURN / turn) } else { step };
            self.pose = self.pose.moved(step.dp, step.dtheta);
            self.look(solids);
        }
    }

    /// Back towards a pose known to be free, until the proxy is free and no worse than there.
    fn back_off(&mut self, solids: &Solids, safe: &Safe, hip: &Pose, metric: &Metric) {
        let ahead = self.pose;
        for s in [0.5, 0.25, 0.125, 0.0] {
            self.pose = safe.pose.interpolate(&ahead, s);
            self.look(solids);
            self.stretch = self.stretch_to(hip);
            if s > 0.0 && self.is_no_worse(safe, metric) {
                return;
            }
        }
        self.steadying.led_nowhere();
    }
}
