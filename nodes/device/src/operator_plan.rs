use crate::OperatorError;
use spatial::{DQuat, DVec3, Pose};

/// One stretch of the intended motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint {
    /// Where the hand wants the part to be at the end, A in the base frame.
    pub pose: Pose,
    /// Time to get there, s, `> 0`.
    pub duration: f64,
    /// A guarded move: the hand stops pushing on as soon as it feels more than this, N, and goes on to the next
    /// waypoint; infinite for an unguarded one.
    pub guard: f64,
    /// Radius of a small circling search across the plan's `up`, metres.
    pub wiggle: f64,
    /// Amplitude of the search's turning to and fro about `up`, rad.
    pub wiggle_turn: f64,
}

/// What the simulated operator intends: waypoints, repeated over and over.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatorPlan {
    /// Where the hand starts, at rest.
    pub start: Pose,
    /// The stretches; after the last comes the first again.
    pub waypoints: Vec<Waypoint>,
    /// The point of the part that the hand watches, in A: errors of aim and tilts turn about it.
    pub tip_a: DVec3,
    /// Away from the obstacle, unit vector in the base frame.
    pub up: DVec3,
}

/// An axis-aligned box, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner.
    pub min: DVec3,
    /// Highest corner.
    pub max: DVec3,
}

impl Bounds {
    /// The box around `points`; `None` without any.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points.into_iter().fold(None, |b: Option<Self>, p| {
            Some(b.map_or(Self { min: p, max: p }, |b| Self { min: b.min.min(p), max: b.max.max(p) }))
        })
    }

    /// Its centre.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Its edge lengths.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }
}

/// How far the intended pose lies below a surface while the hand presses on it, metres: about 1.5 N with an arm of 200 N/m.
const PRESS: f64 = 0.008;

/// `pose` turned by the rotation vector `turn` (rad, base axes) about the point of A `tip_a`, which stays in place.
pub(crate) fn turned_about(pose: &Pose, tip_a: DVec3, turn: DVec3) -> Pose {
    let rotation = (DQuat::from_scaled_axis(turn) * pose.rotation).normalize();
    Pose::new(pose.transform_point(tip_a) - rotation * tip_a, rotation)
}

impl OperatorPlan {
    /// A peg into its hole as a person does it: comes down tilted beside the hole, touches, rights the peg while pressing
    /// it on the plate, slides it over the hole with a small search, lets it drop in and pushes it to the bottom, holds
    /// it there, and pulls it out again. About 8 s.
    ///
    /// `seated` is the pose of A at the bottom, `tip_a` the middle of the peg's lower end in A, `up` (unit) the way out,
    /// `depth` how deep the hole is and `slide` leads from the hole to where the plate is touched first (metres, base frame).
    #[must_use]
    pub fn insertion(seated: Pose, tip_a: DVec3, up: DVec3, depth: f64, slide: DVec3) -> Self {
        let at = |height: f64, aside: DVec3| Pose::new(seated.translation + up * height + aside, seated.rotation);
        let tilt = up.cross(slide).normalize_or(up.any_orthonormal_vector()) * 10f64.to_radians();
        let tilted = |pose: Pose| turned_about(&pose, tip_a, tilt);
        let clear = depth + 0.03;
        let go = |pose, duration| Waypoint { pose, duration, guard: f64::INFINITY, wiggle: 0.0, wiggle_turn: 0.0 };
        let search = |pose, duration| Waypoint { wiggle: 4e-4, wiggle_turn: 0.05, ..go(pose, duration) };
        let waypoints = vec![
            go(tilted(at(depth + 0.012, slide)), 0.8),
            Waypoint { guard: 1.2, ..go(tilted(at(depth - PRESS, slide)), 0.8) },
            go(at(depth - PRESS, slide), 0.6),
            go(at(depth - PRESS, DVec3::ZERO), 0.9),
            search(at(-PRESS, DVec3::ZERO), 2.2),
            go(at(-PRESS, DVec3::ZERO), 0.8),
            go(at(clear, DVec3::ZERO), 1.2),
            go(at(clear, slide), 0.7),
        ];
        Self { start: at(clear, slide), waypoints, tip_a, up }
    }

    /// Touches whatever is there: comes down tilted on the top of the obstacles' box, rights the part, slides across, tilts
    /// it the other way, and lifts it. `moving` is the part's box in A, `fixed` that of the obstacles in the base frame.
    #[must_use]
    pub fn survey(moving: Bounds, fixed: Bounds) -> Self {
        let up = DVec3::Z;
        let tip_a = moving.center().with_z(moving.min.z);
        let top = fixed.center().with_z(fixed.max.z);
        let reach = fixed.size().with_z(0.0) * 0.25;
        let (here, there) = (reach, -reach);
        let lift = 0.01 + 0.3 * moving.size().max_element();
        let at = |height: f64, aside: DVec3| Pose::new(top + aside + up * height - tip_a, DQuat::IDENTITY);
        let tilted = |pose: Pose, angle: f64| {
            turned_about(&pose, tip_a, DVec3::new(1.0, 0.4, 0.0).normalize() * angle.to_radians())
        };
        let go = |pose, duration| Waypoint { pose, duration, guard: f64::INFINITY, wiggle: 0.0, wiggle_turn: 0.0 };
        let touch = |pose, duration| Waypoint { guard: 1.0, ..go(pose, duration) };
        let waypoints = vec![
            touch(tilted(at(-PRESS, here), 12.0), 1.4),
            go(at(-0.5 * PRESS, here), 0.8),
            go(at(-0.5 * PRESS, there), 1.6),
            go(tilted(at(-0.5 * PRESS, there), -12.0), 0.8),
            go(at(lift, there), 1.0),
            go(tilted(at(lift, here), 12.0), 1.0),
        ];
        Self { start: at(lift, here), waypoints, tip_a, up }
    }

    /// Time of one round without guards, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.waypoints.iter().map(|w| w.duration).sum()
    }

    /// Checks every number; NaN fails.
    ///
    /// # Errors
    /// Names the waypoint and what is wrong with it.
    pub fn check(&self) -> Result<(), OperatorError> {
        let bad = |what: String| Err(OperatorError::Plan(what));
        if self.waypoints.is_empty() {
            return bad("the plan has no waypoints".into());
        }
        if !self.start.is_valid()
            || !self.tip_a.is_finite()
            || (self.up.length() - 1.0).abs() > 1e-6
            || self.up.is_nan()
        {
            return bad("the plan's start, tip or up direction is not valid".into());
        }
        for (n, w) in self.waypoints.iter().enumerate() {
            if !w.pose.is_valid() {
                return bad(format!("waypoint {n}: the pose is not valid"));
            }
            if !(w.duration > 0.0 && w.duration.is_finite() && w.guard > 0.0 && w.wiggle >= 0.0 && w.wiggle < 0.1)
                || !(w.wiggle_turn >= 0.0 && w.wiggle_turn < 1.0)
            {
                return bad(format!("waypoint {n}: duration and guard must be > 0, wiggle 0 to 0.1 m and 0 to 1 rad"));
            }
        }
        Ok(())
    }
}
