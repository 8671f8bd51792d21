use spatial::DVec3;

/// Finest grid on a side of the cube of directions.
const MAX_GRID: usize = 64;

/// Where to start looking for the lowest vertex along a direction: a cube of directions, in each cell a vertex that
/// is lowest somewhere in it. Memory O(vertices).
#[derive(Clone, Debug)]
pub(crate) struct SupportTable {
    grid: usize,
    cells: Vec<u32>,
}

impl SupportTable {
    /// A table not made yet.
    pub(crate) const EMPTY: Self = Self { grid: 1, cells: Vec::new() };

    /// A table for `vertices` vertices; `lowest` finds the lowest one along a direction from the vertex given.
    pub(crate) fn new(vertices: usize, first: u32, mut lowest: impl FnMut(DVec3, u32) -> u32) -> Self {
        let grid = ((vertices as f64 / 8.0).sqrt().ceil() as usize).clamp(2, MAX_GRID);
        let mut cells = Vec::with_capacity(6 * grid * grid);
        let at = |i: usize| (2.0 * i as f64 + 1.0) / grid as f64 - 1.0;
        let mut from = first;
        for side in 0..6 {
            for j in 0..grid {
                // Forth and back, so that neighbours in the list are neighbours on the cube.
                let start = cells.len();
                for k in 0..grid {
                    let i = if j % 2 == 0 { k } else { grid - 1 - k };
                    let (one, u, v) = (if side % 2 == 0 { 1.0 } else { -1.0 }, at(i), at(j));
                    let d = match side / 2 {
                        0 => DVec3::new(one, u, v),
                        1 => DVec3::new(v, one, u),
                        _ => DVec3::new(u, v, one),
                    };
                    from = lowest(d.normalize(), from);
                    cells.push(from);
                }
                if j % 2 == 1 {
                    cells[start..].reverse();
                }
            }
        }
        Self { grid, cells }
    }

    /// A vertex near the lowest one along `d`.
    #[inline]
    pub(crate) fn start(&self, d: DVec3) -> u32 {
        let a = d.abs();
        let (side, one, u, v) = if a.x >= a.y && a.x >= a.z {
            (0, d.x, d.y, d.z)
        } else if a.y >= a.z {
            (2, d.y, d.z, d.x)
        } else {
            (4, d.z, d.x, d.y)
        };
        let scale = 0.5 * self.grid as f64 / one.abs();
        let half = 0.5 * self.grid as f64;
        // The cast saturates: not-a-number lands in the first cell.
        let cell = |w: f64| ((w * scale + half) as usize).min(self.grid - 1);
        let side = side + usize::from(one < 0.0);
        self.cells[(side * self.grid + cell(v)) * self.grid + cell(u)]
    }
}
