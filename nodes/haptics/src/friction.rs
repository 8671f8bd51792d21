//! Coulomb friction at the proxy: it holds the points that carry force, up to the cone.

use crate::Gains;
use crate::projection::{Projection, Row};
use crate::proxy::{Metric, Step};
use crate::proxy_view::View;
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
    sliding: bool,
}

impl Friction {
    pub fn new(own: Vec<Option<Coefficients>>) -> Self {
        Self { own, sliding: false }
    }

    pub fn reset(&mut self) {
        self.sliding = false;
    }

    pub fn is_on(&self, gains: &Gains) -> bool {
        gains.friction_static > 0.0 || self.own.iter().flatten().any(|c| c.statically > 0.0)
    }

    /// The friction wrench on the body (N and N.m about the proxy's origin) from the frictionless solution in
    /// `projection`, whose rows stand for `view.points`.
    ///
    /// Solves once more with the centres of pressure held; what holding them takes, cut down to the cone where it
    /// exceeds it, is the friction. It opposes the slip by construction and so can only take energy.
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
        let first = rows.len();
        for place in places.iter().flatten().filter(|p| p.coefficients.statically > 0.0) {
            let arm = place.point - pose.translation;
            let (u, v) = place.normal.any_orthonormal_pair();
            for t in [u, v] {
                if rows.len() < rows.capacity() {
                    rows.push(metric.row(t, arm.cross(t), 0.0, goal, true));
                }
            }
        }
        let mut held = Projection::<6>::new();
        held.solve(rows);
        let mut drag = Wrench::ZERO;
        let mut slides = false;
        for (k, place) in places.iter().flatten().filter(|p| p.coefficients.statically > 0.0).enumerate() {
            let (u, v) = place.normal.any_orthonormal_pair();
            let mut force = DVec3::ZERO;
            for (i, m) in held.active() {
                if i == first + 2 * k {
                    force += u * m;
                } else if i == first + 2 * k + 1 {
                    force += v * m;
                }
            }
            let c = place.coefficients;
            let kinetic = c.kinetically.clamp(0.0, c.statically) * place.force;
            let limit = if self.sliding { kinetic } else { c.statically * place.force };
            let size = force.length();
            if size > limit {
                slides = true;
                force *= kinetic / size;
            }
            let arm = place.point - pose.translation;
            drag = drag + Wrench::new(force, arm.cross(force));
        }
        self.sliding = slides;
        drag
    }
}
