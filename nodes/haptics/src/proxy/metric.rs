//! The metric of the proxy's program, and the rows that contacts are in it.

use crate::Gains;
use crate::projection::Row;
use crate::proxy::steadying::Steadying;
use crate::proxy::step::Step;
use crate::proxy::view::View;
use spatial::{DVec3, Pose, Wrench};

/// The coupling's metric: one over the square roots of its stiffnesses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Metric {
    per_root_f: f64,
    per_root_r: f64,
}

impl Metric {
    pub fn new(gains: &Gains) -> Self {
        // A stiffness of zero would leave the proxy undetermined; the wrench is scaled by the true gains anyway.
        let per_root = |stiffness: f64, least: f64| 1.0 / stiffness.max(least).sqrt();
        Self { per_root_f: per_root(gains.stiffness, 1e-6), per_root_r: per_root(gains.rotation_stiffness, 1e-9) }
    }

    /// The same program with turns held back, and the goal that then leads to the same pose.
    pub fn steadied(&self, steadying: &Steadying, goal: &Step) -> (Self, Step) {
        let factor = steadying.factor();
        let metric = Self { per_root_r: self.per_root_r * factor.sqrt(), ..*self };
        (metric, Step { dtheta: goal.dtheta * factor, ..*goal })
    }

    /// The coupling's energy when it is stretched so far, J.
    pub fn energy(&self, stretch: &Step) -> f64 {
        let square = |v: DVec3, per_root: f64| v.length_squared() / (per_root * per_root);
        0.5 * (square(stretch.dp, self.per_root_f) + square(stretch.dtheta, self.per_root_r))
    }

    pub fn row(&self, normal: DVec3, moment: DVec3, offset: f64, goal: &Step, equality: bool) -> Row<6> {
        let (n, m) = (normal * self.per_root_f, moment * self.per_root_r);
        let offset = offset - normal.dot(goal.dp) - moment.dot(goal.dtheta);
        Row { normal: [n.x, n.y, n.z, m.x, m.y, m.z], offset, equality }
    }

    /// Where the goal is with `wrench` (N and N.m) pulling at the body.
    pub fn pulled(&self, goal: &Step, wrench: &Wrench) -> Step {
        Step {
            dp: goal.dp + wrench.force * (self.per_root_f * self.per_root_f),
            dtheta: goal.dtheta + wrench.torque * (self.per_root_r * self.per_root_r),
        }
    }

    pub fn step(&self, z: &[f64; 6], goal: &Step) -> Step {
        Step {
            dp: goal.dp + DVec3::new(z[0], z[1], z[2]) * self.per_root_f,
            dtheta: goal.dtheta + DVec3::new(z[3], z[4], z[5]) * self.per_root_r,
        }
    }
}

/// One row for each contact in view: it may close its gap, no more.
pub(crate) fn contact_rows(rows: &mut Vec<Row<6>>, view: &View, pose: &Pose, metric: &Metric, goal: &Step) {
    rows.clear();
    for p in &view.points {
        let arm = p.point_w - pose.translation;
        rows.push(metric.row(p.normal_w, arm.cross(p.normal_w), -p.gap, goal, false));
    }
}
