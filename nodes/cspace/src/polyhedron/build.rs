//! From loose faces to a checked polyhedron: weld, orient, merge, link.

use super::{COPLANAR_TOLERANCE, DENT_TOLERANCE, Edge, Plane, Polyhedron, PolyhedronError, Rows};
use crate::{EdgeId, FaceId, VertexId};
use spatial::DVec3;
use std::collections::HashMap;

type Result<T> = std::result::Result<T, PolyhedronError>;

/// The input after welding: loops of vertex numbers, their planes, and the face across each directed edge.
struct Facets<'a> {
    vertices: &'a [DVec3],
    loops: Vec<Vec<u32>>,
    planes: Vec<Plane>,
    across: HashMap<(u32, u32), usize>,
    size: f64,
}

pub(super) fn build(vertices: &[DVec3], faces: &[Vec<u32>]) -> Result<Polyhedron> {
    let facets = Facets::weld(vertices, faces)?;
    facets.check_thickness()?;
    let group = facets.merge()?;
    let loops = facets.merged_loops(&group)?;
    link(vertices, &facets, &group, loops)
}

/// Twice the vector area of a polygon (Newell), about its first vertex so that far bodies lose no digits.
fn vector_area(vertices: &[DVec3], polygon: &[u32]) -> DVec3 {
    let o = vertices[polygon[0] as usize];
    polygon[1..]
        .windows(2)
        .fold(DVec3::ZERO, |sum, w| sum + (vertices[w[0] as usize] - o).cross(vertices[w[1] as usize] - o))
}

/// The plane of a polygon: normal by its vector area, touching its outermost vertex.
fn polygon_plane(vertices: &[DVec3], polygon: &[u32], size: f64) -> Option<Plane> {
    let area = vector_area(vertices, polygon) / (size * size);
    if !(area.length() > 1e-20) {
        return None;
    }
    let normal = area.normalize();
    let distance = polygon.iter().map(|&v| normal.dot(vertices[v as usize])).fold(f64::NEG_INFINITY, f64::max);
    Some(Plane { normal, distance })
}

impl<'a> Facets<'a> {
    fn weld(vertices: &'a [DVec3], faces: &[Vec<u32>]) -> Result<Self> {
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

    fn check_thickness(&self) -> Result<()> {
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
    fn merge(&self) -> Result<Vec<usize>> {
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
    fn merged_loops(&self, group: &[usize]) -> Result<Vec<(usize, Vec<u32>)>> {
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
        let mut used = std::collections::HashSet::new();
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

/// Adjacency of the merged faces, and the checks that need it.
fn link(vertices: &[DVec3], facets: &Facets<'_>, group: &[usize], loops: Vec<(usize, Vec<u32>)>) -> Result<Polyhedron> {
    let size = facets.size;
    let mut planes = Vec::with_capacity(loops.len());
    let mut side: HashMap<(u32, u32), u32> = HashMap::new();
    for (f, (source, ring)) in loops.iter().enumerate() {
        // A face that was not merged keeps its own plane, bit for bit.
        let plane = polygon_plane(vertices, ring, size).ok_or(PolyhedronError::DegenerateFace { face: *source })?;
        planes.push(plane);
        for (i, &from) in ring.iter().enumerate() {
            if side.insert((from, ring[(i + 1) % ring.len()]), f as u32).is_some() {
                return Err(PolyhedronError::NotOneBody { face: *source });
            }
        }
    }
    debug_assert_eq!(group.len(), facets.loops.len());
    let mut edges = Vec::with_capacity(side.len() / 2);
    let mut edge_of: HashMap<(u32, u32), u32> = HashMap::with_capacity(side.len());
    let (mut face_vertices, mut face_edges, mut face_faces) = (Rows::new(), Rows::new(), Rows::new());
    for (f, (source, ring)) in loops.iter().enumerate() {
        let (mut row_edges, mut row_faces) = (Vec::with_capacity(ring.len()), Vec::with_capacity(ring.len()));
        for (i, &from) in ring.iter().enumerate() {
            let to = ring[(i + 1) % ring.len()];
            let Some(&right) = side.get(&(to, from)) else {
                return Err(PolyhedronError::NotOneBody { face: *source });
            };
            let e = *edge_of.entry((from.min(to), from.max(to))).or_insert_with(|| {
                edges.push(Edge { vertices: [VertexId(from), VertexId(to)], faces: [FaceId(f as u32), FaceId(right)] });
                edges.len() as u32 - 1
            });
            row_edges.push(EdgeId(e));
            row_faces.push(FaceId(right));
        }
        face_vertices.push_row(ring.iter().map(|&v| VertexId(v)));
        face_edges.push_row(row_edges);
        face_faces.push_row(row_faces);
    }
    let rings = vertex_rings(vertices.len(), &loops, &side, &edge_of)?;
    let corners = rings.edges.start.windows(2).filter(|w| w[0] != w[1]).count();
    if corners + loops.len() != edges.len() + 2 {
        return Err(PolyhedronError::NotOneBody { face: 0 });
    }
    let mut edge_edges = Rows::new();
    for (e, edge) in edges.iter().enumerate() {
        let near = edge.vertices.iter().flat_map(|v| rings.edges.row(v.index()).iter().copied());
        edge_edges.push_row(near.filter(|n| n.index() != e).collect::<Vec<_>>());
    }
    let mut p = Polyhedron {
        vertices: vertices.to_vec(),
        planes,
        edges,
        face_vertices,
        face_edges,
        face_faces,
        vertex_faces: rings.faces,
        vertex_edges: rings.edges,
        vertex_vertices: rings.vertices,
        edge_edges,
        edge_directions: Vec::new(),
        corners: Vec::new(),
        face_sides: Rows::new(),
        center: DVec3::ZERO,
        radius: 0.0,
        inner_radius: 0.0,
    };
    p.corners = (0..p.vertices.len() as u32).map(VertexId).filter(|v| !p.vertex_edges(*v).is_empty()).collect();
    check_stars(&p, &loops, size)?;
    if !face_graph_connected(&p) {
        return Err(PolyhedronError::NotOneBody { face: 0 });
    }
    set_balls(&mut p);
    p.find_directions();
    Ok(p)
}

struct Rings {
    faces: Rows<FaceId>,
    edges: Rows<EdgeId>,
    vertices: Rows<VertexId>,
}

/// Edges and faces around each vertex, counter-clockwise seen from outside.
fn vertex_rings(
    count: usize,
    loops: &[(usize, Vec<u32>)],
    side: &HashMap<(u32, u32), u32>,
    edge_of: &HashMap<(u32, u32), u32>,
) -> Result<Rings> {
    let mut before: HashMap<(u32, u32), u32> = HashMap::new(); // (face, vertex) -> vertex before it in the loop
    let mut start: Vec<Option<(u32, u32)>> = vec![None; count];
    let mut degree = vec![0usize; count];
    for (_, ring) in loops {
        for (i, &v) in ring.iter().enumerate() {
            let to = ring[(i + 1) % ring.len()];
            let from = ring[(i + ring.len() - 1) % ring.len()];
            before.insert((side[&(v, to)], v), from);
            start[v as usize].get_or_insert((v, to));
            degree[v as usize] += 1;
        }
    }
    let mut out = Rings { faces: Rows::new(), edges: Rows::new(), vertices: Rows::new() };
    for start in start {
        let (mut f, mut e, mut n) = (Vec::new(), Vec::new(), Vec::new());
        if let Some((v, first)) = start {
            let mut to = first;
            loop {
                let face = side[&(v, to)];
                e.push(EdgeId(edge_of[&(v.min(to), v.max(to))]));
                n.push(VertexId(to));
                f.push(FaceId(face));
                // The next edge counter-clockwise is the one by which this face comes back to v.
                to = before[&(face, v)];
                if to == first {
                    break;
                }
                if f.len() > degree[v as usize] {
                    return Err(PolyhedronError::NotOneBody { face: loops[face as usize].0 });
                }
            }
            if f.len() != degree[v as usize] {
                return Err(PolyhedronError::NotOneBody { face: loops[f[0].index()].0 });
            }
        }
        out.faces.push_row(f);
        out.edges.push_row(e);
        out.vertices.push_row(n);
    }
    Ok(out)
}

/// A closed surface of a sphere's topology whose vertex stars are all convex is convex.
fn check_stars(p: &Polyhedron, loops: &[(usize, Vec<u32>)], size: f64) -> Result<()> {
    let tolerance = 4.0 * DENT_TOLERANCE * size;
    for f in p.faces() {
        let (plane, source) = (p.face_plane(f), loops[f.index()].0);
        for &v in p.face_vertices(f) {
            for &w in p.vertex_vertices(v) {
                if plane.signed_distance(p.vertex(w)) > tolerance {
                    return Err(PolyhedronError::NotConvex { face: source, vertex: w.index() });
                }
            }
        }
        // Its own outline turns left everywhere, once around.
        let ring = p.face_vertices(f);
        let mut turning = 0.0;
        for i in 0..ring.len() {
            let [a, b, c] = [0, 1, 2].map(|k| p.vertex(ring[(i + k) % ring.len()]));
            let (u, w) = (b - a, c - b);
            let sine = plane.normal.dot(u.cross(w));
            if sine < -tolerance * (u.length() + w.length()) {
                return Err(PolyhedronError::NotConvex { face: source, vertex: ring[(i + 1) % ring.len()].index() });
            }
            turning += sine.atan2(u.dot(w));
        }
        if (turning - std::f64::consts::TAU).abs() > 1e-3 {
            return Err(PolyhedronError::NotConvex { face: source, vertex: ring[0].index() });
        }
    }
    Ok(())
}

fn face_graph_connected(p: &Polyhedron) -> bool {
    let mut seen = vec![false; p.face_count()];
    let mut stack = vec![FaceId(0)];
    seen[0] = true;
    while let Some(f) = stack.pop() {
        for &g in p.face_faces(f) {
            if !std::mem::replace(&mut seen[g.index()], true) {
                stack.push(g);
            }
        }
    }
    seen.into_iter().all(|s| s)
}

/// A centre near the middle of the largest inscribed ball (steps away from the nearest face), and both radii.
fn set_balls(p: &mut Polyhedron) {
    let corners: Vec<DVec3> = p.corner_ids().map(|v| p.vertex(v)).collect();
    let mut c = corners.iter().copied().sum::<DVec3>() / corners.len() as f64;
    let depth_at = |c: DVec3| {
        p.planes.iter().fold((f64::INFINITY, DVec3::ZERO), |best, f| {
            let d = -f.signed_distance(c);
            if d < best.0 { (d, f.normal) } else { best }
        })
    };
    let mut step = 0.5 * corners.iter().map(|v| v.distance(c)).fold(0.0, f64::max);
    let mut best = (depth_at(c), c);
    for _ in 0..60 {
        let trial = c - best.0.1 * step.min(best.0.0.max(0.0) + step);
        let at = depth_at(trial);
        if at.0 > best.0.0 {
            best = (at, trial);
            c = trial;
        } else {
            step *= 0.75;
        }
    }
    p.center = best.1;
    p.inner_radius = best.0.0.max(0.0);
    p.radius = corners.iter().map(|v| v.distance(best.1)).fold(0.0, f64::max);
}
