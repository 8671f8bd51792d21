//! The faces as they are given: welded, oriented, merged.

use super::{COPLANAR_TOLERANCE, DENT_TOLERANCE, Plane, PolyhedronError};
use spatial::DVec3;
use std::collections::{HashMap, HashSet};

type Result<T> = std::result::Result<T, PolyhedronError>;

/// The input after welding: loops of vertex numbers, their planes, and the face across each directed edge.
pub(super) struct Facets<'a> {
    vertices: &'a [DVec3],
    loops: Vec<Vec<u32>>,
    planes: Vec<Plane>,
    across: HashMap<(u32, u32), usize>,
    /// Half the diagonal of their bounding box, metres: what tolerances are relative to.
    pub(super) size: f64,
}

/// Twice the vector area of a polygon (Newell), about its first vertex so that far bodies lose no digits.
fn vector_area(vertices: &[DVec3], polygon: &[u32]) -> DVec3 {
    let o = vertices[polygon[0] as usize];
    polygon[1..]
        .windows(2)
        .fold(DVec3::ZERO, |sum, w| sum + (vertices[w[0] as usize] - o).cross(vertices[w[1] as usize] - o))
}

/// The plane of a polygon: normal by its vector area, touching its outermost vertex.
pub(super) fn polygon_plane(vertices: &[DVec3], polygon: &[u32], size: f64) -> Option<Plane> {
    let area = vector_area(vertices, polygon) / (size * size);
    if !(area.length() > 1e-20) {
        return None;
    }
    let normal = area.normalize();
    let distance = polygon.iter().map(|&v| normal.dot(vertices[v as usize])).fold(f64::NEG_INFINITY, f64::max);
    Some(Plane { normal, distance })
}

impl<'a> Facets<'a> {
    /// Vertices at the same place made one, and the surface closed and oriented.
    pub(super) fn weld(vertices: &'a [DVec3], faces: &[Vec<u32>]) -> Result<Self> {
        if vertices.is_empty() || faces.is_empty() {
            return Err(PolyhedronError::Empty);
        }
        let mut first_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(vertices.len());
        let mut weld = Vec::with_capacity(vertices.len());
        for (i, v) in vertices.iter().enumerate() {
            if !v.is_finite() || v.abs().max_element() > 1e100 {
                return Err(PolyhedronError::NotFinite { vertex: i });
            }
            // Adding zero turns -0 into +0.
            let key = v.to_array().map(|c| (c + 0.0).to_bits());
            weld.push(*first_at.entry(key).or_insert(i as u32));
        }
        let mut loops = Vec::with_capacity(faces.len());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (face, polygon) in faces.iter().enumerate() {
            let mut ring: Vec<u32> = Vec::with_capacity(polygon.len());
            for &v in polygon {
                let Some(&w) = weld.get(v as usize) else {
                    return Err(PolyhedronError::IndexOutOfRange { face, vertex: v as usize, count: vertices.len() });
                };
                if ring.last() != Some(&w) {
                    ring.push(w);
                }
                low = low.min(vertices[w as usize]);
                high = high.max(vertices[w as usize]);
            }
            while ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            let mut sorted = ring.clone();
            sorted.sort_unstable();
            sorted.dedup();
            if ring.len() < 3 || sorted.len() != ring.len() {
                return Err(PolyhedronError::DegenerateFace { face });
            }
            loops.push(ring);
        }
        let size = 0.5 * (high - low).length();
        if !(size > 1e-100) {
            return Err(PolyhedronError::DegenerateFace { face: 0 });
        }
        let mut planes = Vec::with_capacity(loops.len());
        let mut across = HashMap::with_capacity(loops.len() * 3);
        for (face, ring) in loops.iter().enumerate() {
            let plane = polygon_plane(vertices, ring, size).ok_or(PolyhedronError::DegenerateFace { face })?;
            if let Some(&v) =
                ring.iter().find(|&&v| plane.signed_distance(vertices[v as usize]) < -2.0 * DENT_TOLERANCE * size)
            {
                return Err(PolyhedronError::NotPlanar { face, vertex: v as usize });
            }
            for (i, &from) in ring.iter().enumerate() {
                let to = ring[(i + 1) % ring.len()];
                if across.insert((from, to), face).is_some() {
                    return Err(PolyhedronError::NotOriented { face, from: from as usize, to: to as usize });
                }
            }
            planes.push(plane);
        }
        for (face, ring) in loops.iter().enumerate() {
            for (i, &from) in ring.iter().enumerate() {
                let to = ring[(i + 1) % ring.len()];
                if !across.contains_key(&(to, from)) {
                    return Err(PolyhedronError::Open { face, from: from as usize, to: to as usize });
                }
            }
        }
        Ok(Self { vertices, loops, planes, across, size })
    }

    /// It has an inside, and its faces look outwards.
    pub(super) fn check_thickness(&self) -> Result<()> {
        let area = |f: usize| vector_area(self.vertices, &self.loops[f]);
        let largest =
            (0..self.loops.len()).max_by(|&f, &g| area(f).length().total_cmp(&area(g).length())).unwrap_or_default();
        let below = |f: usize| {
            let depth = |v: &u32| -self.planes[f].signed_distance(self.vertices[*v as usize]);
            self.loops.iter().flatten().map(depth).fold(f64::NEG_INFINITY, f64::max)
        };
        let o = self.vertices[self.loops[0][0] as usize];
        let volume: f64 =
            (0..self.loops.len()).map(|f| area(f).dot(self.vertices[self.loops[f][0] as usize] - o)).sum();
        if volume < -1e-9 * self.size.powi(3) {
            return Err(PolyhedronError::InsideOut { face: 0 });
        }
        if below(largest) < 1e-9 * self.size {
            return Err(PolyhedronError::Flat { face: largest });
        }
        Ok(())
    }

    /// Which merged face each input face belongs to, by union over edges that do not bulge.
    pub(super) fn merge(&self) -> Result<Vec<usize>> {
        let mut parent: Vec<usize> = (0..self.loops.len()).collect();
        fn root(parent: &mut [usize], mut i: usize) -> usize {
            while parent[i] != i {
                parent[i] = parent[parent[i]];
                i = parent[i];
            }
            i
        }
        for (f, ring) in self.loops.iter().enumerate() {
            for (i, &from) in ring.iter().enumerate() {
                let g = self.across[&(ring[(i + 1) % ring.len()], from)];
                if g <= f {
                    continue;
                }
                // How far each one's vertices stay below the other's plane: the clearer of the two views decides.
                let (low_g, high_g) = self.range(f, g);
                let (low_f, high_f) = self.range(g, f);
                let dent = high_g.min(high_f);
                if dent > DENT_TOLERANCE * self.size {
                    let (face, other) = if high_g <= high_f { (f, g) } else { (g, f) };
                    let vertex = self.highest(face, other);
                    return Err(PolyhedronError::NotConvex { face, vertex });
                }
                let bulge = (-low_g).max(-low_f);
                let same_side = self.planes[f].normal.dot(self.planes[g].normal) > 0.0;
                let concave = high_g > COPLANAR_TOLERANCE * self.size && high_f > COPLANAR_TOLERANCE * self.size;
                if same_side && (bulge <= COPLANAR_TOLERANCE * self.size || concave) {
                    let (a, b) = (root(&mut parent, f), root(&mut parent, g));
                    parent[a.max(b)] = a.min(b);
                } else if concave && !same_side {
                    return Err(PolyhedronError::NotConvex { face: f, vertex: self.highest(f, g) });
                }
            }
        }
        Ok((0..parent.len()).map(|i| root(&mut parent, i)).collect())
    }

    /// Lowest and highest signed distance of `g`'s vertices to the plane of `f`.
    fn range(&self, f: usize, g: usize) -> (f64, f64) {
        self.loops[g]
            .iter()
            .map(|&v| self.planes[f].signed_distance(self.vertices[v as usize]))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)))
    }

    fn highest(&self, f: usize, g: usize) -> usize {
        let d = |v: u32| self.planes[f].signed_distance(self.vertices[v as usize]);
        self.loops[g].iter().copied().max_by(|&a, &b| d(a).total_cmp(&d(b))).unwrap_or_default() as usize
    }

    /// The outline of each group of input faces, keyed by the group's number; straight vertices removed.
    pub(super) fn merged_loops(&self, group: &[usize]) -> Result<Vec<(usize, Vec<u32>)>> {
        let mut next: HashMap<(usize, u32), u32> = HashMap::new();
        for (f, ring) in self.loops.iter().enumerate() {
            for (i, &from) in ring.iter().enumerate() {
                let to = ring[(i + 1) % ring.len()];
                if group[self.across[&(to, from)]] != group[f] && next.insert((group[f], from), to).is_some() {
                    return Err(PolyhedronError::NotOneBody { face: f });
                }
            }
        }
        // A vertex stays if at least three merged faces meet there.
        let mut degree: HashMap<u32, u32> = HashMap::new();
        for &(_, from) in next.keys() {
            *degree.entry(from).or_default() += 1;
        }
        let mut starts: Vec<(usize, u32)> = next.keys().copied().collect();
        starts.sort_unstable();
        let mut used = HashSet::new();
        let mut out: Vec<(usize, Vec<u32>)> = Vec::new();
        for (g, start) in starts {
            if used.contains(&(g, start)) {
                continue;
            }
            if out.last().is_some_and(|(last, _)| *last == g) {
                return Err(PolyhedronError::NotOneBody { face: g });
            }
            let mut ring = Vec::new();
            let mut v = start;
            while used.insert((g, v)) {
                if degree[&v] >= 3 {
                    ring.push(v);
                }
                let Some(&to) = next.get(&(g, v)) else {
                    return Err(PolyhedronError::NotOneBody { face: g });
                };
                v = to;
            }
            if v != start {
                return Err(PolyhedronError::NotOneBody { face: g });
            }
            if ring.len() < 3 {
                return Err(PolyhedronError::DegenerateFace { face: g });
            }
            out.push((g, ring));
        }
        Ok(out)
    }
}
