use spatial::DVec3;

/// A type-C C-face: the points `b + beta u_B - alpha u_A` of its plane, with `b` the difference of the edges' first
/// ends and `u` their unit directions, W.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parallelogram {
    /// How far `x`'s projection lies beyond the sides at the ends of B's edge, metres; `< 0` on the face's side.
    pub beyond_b: [f64; 2],
    /// The same at the ends of A's edge.
    pub beyond_a: [f64; 2],
    /// Sine of the angle between the edges.
    pub sine: f64,
}

/// An edge's unit direction in W and its length in metres.
pub(crate) type Span = (DVec3, f64);

impl Parallelogram {
    /// `n`: unit normal; `w`: from the point `alpha = beta = 0` to `x`.
    #[inline]
    pub(crate) fn new(n: DVec3, w: DVec3, (u_a, length_a): Span, (u_b, length_b): Span) -> Self {
        // In the plane w = beta u_B - alpha u_A: the products below are beta, alpha and 1, each times the sine.
        let across = w.cross(n);
        let (at_b, at_a, sine) = (u_a.dot(across), u_b.dot(across), u_b.cross(n).dot(u_a));
        let sign = if sine < 0.0 { -1.0 } else { 1.0 };
        let (at_b, at_a, sine) = (sign * at_b, sign * at_a, sine.abs());
        Self { beyond_b: [-at_b, at_b - length_b * sine], beyond_a: [-at_a, at_a - length_a * sine], sine }
    }

    /// The largest of the distances beyond a side, metres.
    #[inline]
    pub(crate) fn outermost(&self) -> f64 {
        larger(larger(self.beyond_b[0], self.beyond_b[1]), larger(self.beyond_a[0], self.beyond_a[1]))
    }
}

/// The larger number, in one instruction: what it does with not-a-number does not matter here.
#[inline]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
