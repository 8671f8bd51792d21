//! An edge of A cut by the sides of B's face (Cyrus and Beck 1978).

/// What of an edge of A lies over B's face: from where to where, 0 to 1, and the sides of B's face that cut it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub enter: Cut,
    pub leave: Cut,
}

/// Where an edge is cut, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    pub at: f64,
    /// Where the side's own line is crossed: what lies outside by a little counts as inside.
    pub line: f64,
    /// `NONE` where the edge's own end lies over the face.
    pub side: u32,
}

impl Cut {
    pub const NONE: u32 = u32::MAX;
}

impl Span {
    pub const WHOLE: Self =
        Self { enter: Cut { at: 0.0, line: 0.0, side: Cut::NONE }, leave: Cut { at: 1.0, line: 1.0, side: Cut::NONE } };

    /// Cuts by the side `side`, beyond which the ends lie by `p` and `q`, metres; up to `same` counts as inside.
    #[inline]
    pub fn cut(&mut self, side: u32, p: f64, q: f64, same: f64) {
        let (outside_p, outside_q) = (p > same, q > same);
        if outside_p == outside_q {
            if outside_p {
                self.enter.at = f64::INFINITY;
            }
            return;
        }
        let per = 1.0 / (p - q);
        let cut = Cut { at: (p - same) * per, line: (p * per).clamp(0.0, 1.0), side };
        if outside_p {
            if cut.at >= self.enter.at {
                self.enter = cut;
            }
        } else if cut.at <= self.leave.at {
            self.leave = cut;
        }
    }

    pub fn is_empty(&self) -> bool {
        self.enter.at > self.leave.at
    }
}
