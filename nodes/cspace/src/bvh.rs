use spatial::DVec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    pub low: DVec3,
    pub high: DVec3,
}

impl Aabb {
    pub(crate) const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    pub(crate) fn of(points: impl Iterator<Item = DVec3>) -> Self {
        points.fold(Self::EMPTY, |b, p| Self { low: b.low.min(p), high: b.high.max(p) })
    }

    fn join(self, o: Self) -> Self {
        Self { low: self.low.min(o.low), high: self.high.max(o.high) }
    }

    /// Square of the distance from a point, 0 inside.
    #[inline]
    pub(crate) fn distance_squared(&self, p: DVec3) -> f64 {
        (self.low - p).max(p - self.high).max(DVec3::ZERO).length_squared()
    }
}

/// A node: a leaf holds items `first .. first + count`; an inner node's left child follows it, `first` is the right one.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    first: u32,
    count: u32,
}

/// A static tree of boxes, built once by median splits: O(log n) deep, queried without allocation.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
    bounds: Vec<Aabb>,
}

const LEAF: usize = 4;
/// Deeper than any median tree over `u32` items.
const DEPTH: usize = 64;

impl Bvh {
    pub(crate) fn new(bounds: Vec<Aabb>) -> Self {
        let mut tree = Self { nodes: Vec::new(), items: (0..bounds.len() as u32).collect(), bounds };
        if !tree.items.is_empty() {
            let mut items = std::mem::take(&mut tree.items);
            tree.split(&mut items, 0);
            tree.items = items;
        }
        tree
    }

    fn split(&mut self, items: &mut [u32], offset: usize) {
        let bounds = items.iter().fold(Aabb::EMPTY, |b, &i| b.join(self.bounds[i as usize]));
        let at = self.nodes.len();
        self.nodes.push(Node { bounds, first: offset as u32, count: items.len() as u32 });
        if items.len() <= LEAF {
            return;
        }
        let size = bounds.high - bounds.low;
        let axis = (0..3).max_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap_or(0);
        let middle = items.len() / 2;
        let key = |i: &u32| self.bounds[*i as usize].low[axis] + self.bounds[*i as usize].high[axis];
        items.select_nth_unstable_by(middle, |i, j| key(i).total_cmp(&key(j)).then(i.cmp(j)));
        let (left, right) = items.split_at_mut(middle);
        self.split(left, offset);
        self.nodes[at].first = self.nodes.len() as u32;
        self.nodes[at].count = 0;
        self.split(right, offset + middle);
    }

    /// Hands over every item whose box is within `radius` of `center`.
    pub(crate) fn query(&self, center: DVec3, radius: f64, mut found: impl FnMut(u32)) {
        if self.nodes.is_empty() {
            return;
        }
        let r2 = radius * radius;
        let mut stack = [0u32; DEPTH];
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let at = stack[open];
            let node = &self.nodes[at as usize];
            if node.bounds.distance_squared(center) > r2 {
                continue;
            }
            if node.count > 0 {
                for &i in &self.items[node.first as usize..(node.first + node.count) as usize] {
                    if self.bounds[i as usize].distance_squared(center) <= r2 {
                        found(i);
                    }
                }
            } else if open + 2 <= DEPTH {
                stack[open] = node.first;
                stack[open + 1] = at + 1;
                open += 2;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn query_finds_what_trying_all_finds() {
        let bounds: Vec<Aabb> = (0..997u32)
            .map(|i| {
                let p = DVec3::new(f64::from(i * 37 % 101), f64::from(i * 53 % 97), f64::from(i * 29 % 89));
                Aabb { low: p, high: p + DVec3::splat(f64::from(i % 7)) }
            })
            .collect();
        let tree = Bvh::new(bounds.clone());
        for (center, radius) in [(DVec3::splat(40.0), 12.0), (DVec3::ZERO, 3.0), (DVec3::splat(-50.0), 5.0)] {
            let mut found = Vec::new();
            tree.query(center, radius, |i| found.push(i));
            found.sort_unstable();
            let all: Vec<u32> = (0..bounds.len() as u32)
                .filter(|i| bounds[*i as usize].distance_squared(center) <= radius * radius)
                .collect();
            assert_eq!(found, all);
        }
    }
}
