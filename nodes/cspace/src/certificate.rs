use crate::walk::{Found, Placed};
use spatial::{DQuat, DVec3, Pose};

/// A proof that the ball about `x` that touches Near's plane lies wholly in the C-obstacle: then the depth is the
/// global minimum and `x` is not free. It was made at one pose and holds while the motion since stays below its slack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Certificate {
    center_a: DVec3,
    rotation: DQuat,
    normal: DVec3,
    depth: f64,
    /// Directions within twice this angle's tangent of the normal are left to the C-face's own extent.
    pub tan_half_cap: f64,
    /// By how much every other plane is farther than Near's, metres; `< 0` if there is no proof.
    pub slack: f64,
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

    pub(crate) fn new(placed: &Placed<'_>, pose: &Pose, near: &Found, tan_half_cap: f64, slack: f64) -> Self {
        Self {
            center_a: placed.center,
            rotation: pose.rotation,
            normal: near.face.normal_w,
            depth: -near.face.distance,
            tan_half_cap,
            slack,
        }
    }

    /// Whether the proof still holds, and goes on doing so within `room` ([`Found::room`]): no plane moves by more than `|dc| + r dtheta` along its normal, with `c` the centre of A and `r` its radius.
    #[inline]
    pub(crate) fn holds(&self, placed: &Placed<'_>, pose: &Pose, near: &Found, room: f64) -> bool {
        let (e, s) = (room - near.face.distance, near.inside - room);
        let n = near.face.normal_w;
        if self.slack < 0.0 {
            return false;
        }
        let q = if self.rotation.dot(pose.rotation) < 0.0 { -self.rotation } else { self.rotation };
        // |q - q0| = 2 sin(theta / 4); 2.1 |q - q0| >= theta up to 1.5 rad.
        let chord = (pose.rotation - q).length();
        let motion = (placed.center - self.center_a).length() + 2.1 * chord * placed.a.radius + room;
        let turn = ((n - self.normal).length_squared() / (n + self.normal).length_squared().max(1e-300)).sqrt();
        // And by so much more within the room: tan(t/2) < 0.55 t for the turns that pass.
        let more = 0.55 * near.normal_turn * room / near.lever;
        let turn = (turn + more) / (1.0 - turn * more);
        let cap = self.tan_half_cap;
        chord < 0.7
            && motion + (e - self.depth).max(0.0) <= self.slack
            && more < 0.25
            && turn >= 0.0
            && cap * turn < 1.0
            && s * (1.0 - cap * turn) >= e * (cap + turn)
    }
}

/// The same proof from the bodies' inscribed balls alone, in closed form: the hull of the disc about the SCP in the
/// C-face and of the ball that the C-obstacle holds about `c_B - R c_A` contains the ball about `x`, and goes on doing
/// so within `room` ([`Found::room`]): seen from `x` and Near's normal, the disc shrinks and the depth grows by that at
/// most, and the ball's centre moves as A's does and by its distance times the normal's turn.
#[inline]
pub(crate) fn inscribed_ball_proves(placed: &Placed<'_>, near: &Found, room: f64) -> bool {
    let (e, s) = (room - near.face.distance, near.inside - room);
    let n = near.face.normal_w;
    let to_ball = placed.b.center - placed.center;
    let shake = if room > 0.0 { room * (near.normal_turn * to_ball.length() / near.lever).max(1.0) } else { 0.0 };
    let rho = placed.a.inner_radius + placed.b.inner_radius - shake;
    let down = -n.dot(to_ball); // depth of the ball's centre below x
    let lateral2 = (to_ball.length_squared() - down * down).max(0.0);
    if !(s > 0.0 && down > 0.0 && rho > e) {
        return false;
    }
    // Support in a direction at angle t from n: the disc gives enough while tan(t/2) <= s/e, the ball where
    // (rho - e) >= down cos t + lateral sin t, which is hardest at tan t = lateral/down.
    if down * down + lateral2 <= (rho - e) * (rho - e) {
        return true;
    }
    let lateral = lateral2.sqrt();
    let (e2, s2) = (e * e, s * s);
    (rho - e) * (e2 + s2) - down * (e2 - s2) - 2.0 * lateral * s * e >= 0.0
        && 2.0 * s * e * down - (e2 - s2) * lateral >= 0.0
}
