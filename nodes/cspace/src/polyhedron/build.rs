//! From loose faces to a checked polyhedron: weld, merge, link.

use super::facets::{Facets, polygon_plane};
use super::{DENT_TOLERANCE, Edge, Polyhedron, PolyhedronError, Rows};
use crate::{EdgeId, FaceId, VertexId};
use spatial::DVec3;
use std::collections::HashMap;

type Result<T> = std::result::Result<T, PolyhedronError>;

pub(super) fn build(vertices: &[DVec3], faces: &[Vec<u32>]) -> Result<Polyhedron> {
    let facets = Facets::weld(vertices, faces)?;
    facets.check_thickness()?;
    let group = facets.merge()?;
    let loops = facets.merged_loops(&group)?;
    link(vertices, facets.size, loops)
}

/// Adjacency of the merged faces, and the checks that need it.
fn link(vertices: &[DVec3], size: f64, loops: Vec<(usize, Vec<u32>)>) -> Result<Polyhedron> {
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
    let corners = rings.edges.spans.iter().filter(|[from, to]| from != to).count();
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
