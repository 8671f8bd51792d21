use crate::CFace;
use crate::calm::Unrest;
use crate::placed::Placed;
use spatial::{DQuat, DVec3};

/// A proof that the ball about `x` that touches Near's plane lies wholly in the C-obstacle: then the depth is the
/// global minimum and `x` is not free. It was made at one pose and holds while the motion since stays below its slack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Certificate {
    center_a: DVec3,
    rotation: DQuat,
    normal: DVec3,
    depth: f64,
    /// Directions within twice this angle's tangent of the normal are left to the C-face's own extent.
    tan_half_cap: f64,
    /// By how much every other plane is farther than Near's, metres; `< 0` if there is no proof.
    slack: f64,
}

impl Certificate {
    pub(crate) const NONE: Self = Self {
        center_a: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        normal: DVec3::ZERO,
        depth: 0.0,
        tan_half_cap: 0.0,
        slack: -1.0,
    };

    pub(crate) fn new(placed: &Placed<'_>, near: &CFace, tan_half_cap: f64, slack: f64) -> Self {
        Self {
            center_a: placed.at.center,
            rotation: placed.at.pose.rotation,
            normal: near.normal_w,
            depth: -near.distance,
            tan_half_cap,
            slack,
        }
    }

    /// Whether Near's depth is proven: by the inscribed balls, or by this. `inside`: radius of a disc of the C-face
    /// about the SCP, metres, or what counts for as much.
    #[inline]
    pub(crate) fn proves(&self, placed: &Placed<'_>, near: &CFace, inside: f64) -> bool {
        inscribed_ball_proves(placed, near, inside) || self.holds(placed, near, inside)
    }

    /// The same for all poses to which Near's plane may move by no more than `unrest`; `inside` is what the disc keeps meanwhile.
    pub(crate) fn proves_within(&self, placed: &Placed<'_>, near: &CFace, inside: f64, unrest: Unrest) -> bool {
        inscribed_ball_proves_within(placed, near, inside, unrest) || self.holds_within(placed, near, inside, unrest)
    }

    /// Whether the proof still holds for Near's plane at this pose, with x's projection `inside` metres from its sides:
    /// no plane moves by more than `|dc| + r dtheta` along its normal, with `c` the centre of A and `r` its radius.
    fn holds(&self, placed: &Placed<'_>, near: &CFace, inside: f64) -> bool {
        self.holds_within(placed, near, inside, Unrest { way: 0.0, normal: 0.0 })
    }

    #[inline]
    fn holds_within(&self, placed: &Placed<'_>, near: &CFace, inside: f64, unrest: Unrest) -> bool {
        if self.slack < 0.0 {
            return false;
        }
        let (e, n) = (unrest.way - near.distance, near.normal_w);
        let rotation = placed.at.pose.rotation;
        let q = if self.rotation.dot(rotation) < 0.0 { -self.rotation } else { self.rotation };
        // |q - q0| = 2 sin(theta / 4); 2.1 |q - q0| >= theta up to 1.5 rad.
        let chord = (rotation - q).length();
        let motion = (placed.at.center - self.center_a).length() + 2.1 * chord * placed.a.radius + unrest.way;
        let turn = ((n - self.normal).length_squared() / (n + self.normal).length_squared().max(1e-300)).sqrt();
        // The tangent of half an angle up to a right one grows no faster than the angle.
        let turn = turn + unrest.normal;
        let cap = self.tan_half_cap;
        chord < 0.7
            && motion + (e - self.depth).max(0.0) <= self.slack
            && cap * turn < 1.0
            && inside * (1.0 - cap * turn) >= e * (cap + turn)
    }
}

/// The same proof from the bodies' inscribed balls alone, in closed form: the hull of the disc about the SCP in the
/// C-face and of the ball that the C-obstacle holds about `c_B - R c_A` contains the ball about `x`.
#[inline]
fn inscribed_ball_proves(placed: &Placed<'_>, near: &CFace, inside: f64) -> bool {
    let (e, s) = (-near.distance, inside);
    let to_ball = placed.b.center - placed.at.center;
    let rho = placed.a.inner_radius + placed.b.inner_radius;
    let down = -near.normal_w.dot(to_ball); // depth of the ball's centre below x
    let distance2 = to_ball.length_squared();
    if !(s > 0.0 && down > 0.0 && rho > e) {
        return false;
    }
    // Support in a direction at angle t from n: the disc gives enough while tan(t/2) <= s/e, the ball where
    // (rho - e) >= down cos t + lateral sin t, which is hardest at tan t = lateral/down.
    if distance2 <= (rho - e) * (rho - e) {
        return true;
    }
    let lateral = (distance2 - down * down).max(0.0).sqrt();
    let (e2, s2) = (e * e, s * s);
    (rho - e) * (e2 + s2) - down * (e2 - s2) - 2.0 * lateral * s * e >= 0.0
        && 2.0 * s * e * down - (e2 - s2) * lateral >= 0.0
}

/// The same for all poses to which the pair may move by no more than `unrest`, `inside` being the least: each number is taken where it
/// asks most.
fn inscribed_ball_proves_within(placed: &Placed<'_>, near: &CFace, inside: f64, unrest: Unrest) -> bool {
    let e = [(-near.distance - unrest.way).max(0.0), unrest.way - near.distance];
    let to_ball = placed.b.center - placed.at.center;
    let rho = placed.a.inner_radius + placed.b.inner_radius - e[1];
    let down = -near.normal_w.dot(to_ball);
    let distance = to_ball.length();
    let moved = unrest.way + unrest.normal * distance;
    let s = inside;
    if !(s > 0.0 && down > moved && rho > 0.0) {
        return false;
    }
    if distance + unrest.way <= rho {
        return true;
    }
    let lateral = (distance * distance - down * down).max(0.0).sqrt() + moved;
    let s2 = s * s;
    let (e2, over) = (e.map(|e| e * e), (e[1] * e[1] - s2));
    let down = [down - moved, down + moved];
    let sinks = if over > 0.0 { down[1] } else { down[0] } * over;
    rho * (e2[0] + s2) - sinks - 2.0 * lateral * s * e[1] >= 0.0
        && 2.0 * s * e[0] * down[0] - over.max(0.0) * lateral >= 0.0
}
