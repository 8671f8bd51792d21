//! Coulomb friction at the proxy: it holds the points that carry force, up to the cone.

use crate::Gains;
use crate::projection::{Projection, Row};
use crate::proxy::metric::{Metric, contact_rows};
use crate::proxy::step::Step;
use crate::proxy::view::View;
use spatial::{DVec3, Pose, Wrench};

/// Coefficients of one obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Static coefficient.
    pub statically: f64,
    /// Kinetic coefficient, at most the static one.
    pub kinetically: f64,
}

/// Most places that friction holds at once.
const HELD: usize = 4;
/// Times that the places are held in turn, at most, and the change (N) below which they are done.
const TURNS: usize = 4;
const SETTLED: f64 = 1e-9;
/// A slip (metres) that is none, and the part of a slip that may be left across it: the normals hold no better.
const STILL: f64 = 1e-12;
const BLOCKED: f64 = 1e-6;
/// Force-carrying contacts with normals this close together (cosine) share one place.
const ALIKE: f64 = 0.99;

/// A place that carries force: centre of pressure, mean normal, total normal force.
#[derive(Clone, Copy, Debug)]
struct Place {
    point: DVec3,
    normal: DVec3,
    force: f64,
    coefficients: Coefficients,
}

/// Friction's state and settings.
#[derive(Clone, Debug)]
pub(crate) struct Friction {
    /// For each fixed piece; none falls back to the gains.
    own: Vec<Option<Coefficients>>,
    /// Whether a place slides in this tick, and whether one did in the last.
    sliding: bool,
    slid: bool,
}

impl Friction {
    pub fn new(own: Vec<Option<Coefficients>>) -> Self {
        Self { own, sliding: false, slid: false }
    }

    pub fn reset(&mut self) {
        (self.sliding, self.slid) = (false, false);
    }

    /// A tick begins.
    pub fn begin(&mut self) {
        self.slid = std::mem::take(&mut self.sliding);
    }

    pub fn is_on(&self, gains: &Gains) -> bool {
        gains.friction_static > 0.0 || self.own.iter().flatten().any(|c| c.statically > 0.0)
    }

    /// The friction wrench on the body (N and N.m about the proxy's origin) in a round of the tick, from the frictionless solution
    /// in `projection`, whose rows stand for `view.points`. Where a round leads to other contacts, what held before holds no more.
    ///
    /// Holds the centres of pressure in turn, each against what the others' friction leaves; what holding one takes, cut
    /// down to its cone where it exceeds it, is its friction. (Held all at once, two walls may pull against each other as a
    /// couple; each cut down on its own, such a pair would push.) The normals carry what they can first.
    #[expect(clippy::too_many_arguments, reason = "one call site; a struct would only rename them")]
    pub fn drag(
        &mut self,
        view: &View,
        projection: &Projection<6>,
        rows: &mut Vec<Row<6>>,
        metric: &Metric,
        goal: &Step,
        pose: &Pose,
        gains: &Gains,
    ) -> Wrench {
        let places = self.places(view, projection, gains);
        let mut forces = [DVec3::ZERO; HELD];
        let mut drag = Wrench::ZERO;
        let held = || places.iter().flatten().enumerate().filter(|(_, p)| p.coefficients.statically > 0.0);
        let mut sliding = false;
        for _ in 0..TURNS {
            sliding = false;
            let mut change = 0.0_f64;
            for (k, place) in held() {
                let arm = place.point - pose.translation;
                let others = drag - Wrench::new(forces[k], arm.cross(forces[k]));
                let goal = metric.pulled(goal, &others);
                contact_rows(rows, view, pose, metric, &goal);
                let mut force = Self::hold(place, arm, rows, projection.clone(), metric, &goal);
                let c = place.coefficients;
                let kinetic = c.kinetically.clamp(0.0, c.statically) * place.force;
                let limit = if self.slid { kinetic } else { c.statically * place.force };
                let size = force.length();
                if size > limit {
                    sliding = true;
                    force *= kinetic / size;
                }
                change = change.max(force.distance(forces[k]));
                forces[k] = force;
                drag = others + Wrench::new(force, arm.cross(force));
            }
            if change <= SETTLED || held().count() < 2 {
                break;
            }
        }
        self.sliding |= sliding;
        drag
    }

    /// The force (N) that keeps the place where it is, with as much of it as possible left to the normals: they alone, then the
    /// way it slips, then what still slips across.
    fn hold(
        place: &Place,
        arm: DVec3,
        rows: &mut Vec<Row<6>>,
        mut solution: Projection<6>,
        metric: &Metric,
        goal: &Step,
    ) -> DVec3 {
        let first = rows.len();
        let mut tangents = [DVec3::ZERO; 2];
        let mut least = STILL;
        for k in 0..2 {
            solution.solve_again(rows);
            let step = metric.step(&solution.z, goal);
            let slip = (step.dp + step.dtheta.cross(arm)).reject_from_normalized(place.normal);
            let tangent = if k == 0 { slip.normalize_or_zero() } else { place.normal.cross(tangents[0]) };
            if slip.dot(tangent).abs() <= least || rows.len() == rows.capacity() {
                break;
            }
            least += BLOCKED * slip.length();
            tangents[k] = tangent;
            rows.push(metric.row(tangent, arm.cross(tangent), 0.0, goal, true));
        }
        solution.solve_again(rows);
        let pull = |(i, m): (usize, f64)| i.checked_sub(first).map_or(DVec3::ZERO, |k| tangents[k] * m);
        solution.active().map(pull).sum()
    }

    /// Where the frictionless solution presses.
    fn places(&self, view: &View, projection: &Projection<6>, gains: &Gains) -> [Option<Place>; HELD] {
        let mut places = [None::<Place>; HELD];
        for (i, force) in projection.active() {
            let Some(p) = view.points.get(i).filter(|_| force > 0.0) else { continue };
            let piece = view.pairs.iter().find(|pair| (pair.first..pair.end).contains(&i)).map(|pair| pair.piece);
            let coefficients = piece
                .and_then(|k| self.own.get(k as usize).copied().flatten())
                .unwrap_or(Coefficients { statically: gains.friction_static, kinetically: gains.friction_kinetic });
            let slot = places
                .iter_mut()
                .find(|s| s.is_none_or(|q| q.normal.dot(p.normal_w) > ALIKE && q.coefficients == coefficients));
            match slot {
                Some(Some(q)) => {
                    let total = q.force + force;
                    q.point = (q.point * q.force + p.point_w * force) / total;
                    q.normal = (q.normal * q.force + p.normal_w * force).normalize_or(q.normal);
                    q.force = total;
                }
                Some(slot) => *slot = Some(Place { point: p.point_w, normal: p.normal_w, force, coefficients }),
                None => {}
            }
        }
        places
    }
}
