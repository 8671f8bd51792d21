//! How much of a corner the edges and vertices of a body are.

use cspace::{EdgeId, Polyhedron, VertexId};
use spatial::DVec3;

/// A surface that bends by this much, radians, has an edge there; by less, that part of one.
const EDGE: f64 = 0.2;

/// For each edge and vertex of a body how much of one it is: from nought, where the surface is flat (along an edge of the body there
/// is no vertex), to 1.
///
/// Meshes cut flat faces into facets that bend by their rounding, and curved ones as finely as they like.
#[derive(Clone, Debug)]
pub(crate) struct Sharpness {
    edges: Vec<f32>,
    vertices: Vec<f32>,
}

impl Sharpness {
    pub fn of(body: &Polyhedron) -> Self {
        let part = |bend: f64| (bend / EDGE).min(1.0) as f32;
        let edge = |e| {
            let [n, m] = body.edge(e).faces.map(|f| body.face_plane(f).normal);
            part(n.distance(m))
        };
        let vertex = |v| {
            let normals: Vec<DVec3> = body.vertex_faces(v).iter().map(|f| body.face_plane(*f).normal).collect();
            part(width(&normals))
        };
        Self {
            edges: body.edges().map(edge).collect(),
            vertices: (0..body.vertices().len() as u32).map(|v| vertex(VertexId(v))).collect(),
        }
    }

    pub fn of_edge(&self, edge: EdgeId) -> f32 {
        self.edges[edge.index()]
    }

    pub fn of_vertex(&self, vertex: VertexId) -> f32 {
        self.vertices[vertex.index()]
    }
}

/// The least width of the cone of normals around a vertex, in their order, metres per metre: nought, where they lie in one plane.
fn width(normals: &[DVec3]) -> f64 {
    let middle = normals.iter().sum::<DVec3>().normalize_or_zero();
    let width_along = |across: DVec3| {
        let ends = normals.iter().map(|n| n.dot(across));
        let (least, most) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), x| (l.min(x), m.max(x)));
        most - least
    };
    let sides = normals.iter().zip(normals.iter().cycle().skip(1));
    let across = sides.filter_map(|(n, m)| middle.cross(*m - *n).try_normalize());
    across.map(width_along).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box whose top is a pyramid `rise` high, with a vertex in the middle of one of the top's sides, `out` from the line.
    fn roofed(rise: f64, out: f64) -> Polyhedron {
        let mut points: Vec<DVec3> = (0..8)
            .map(|i| DVec3::new(f64::from(i & 1) - 0.5, f64::from(i >> 1 & 1) - 0.5, -f64::from(i >> 2)))
            .collect();
        points.extend([DVec3::new(0.0, 0.0, rise), DVec3::new(0.0, -0.5 - out, 0.0)]);
        let faces = [
            vec![4, 6, 7, 5],
            vec![0, 2, 6, 4],
            vec![1, 5, 7, 3],
            vec![2, 3, 7, 6],
            vec![4, 9, 0],
            vec![4, 5, 9],
            vec![5, 1, 9],
            vec![8, 0, 9],
            vec![8, 9, 1],
            vec![8, 1, 3],
            vec![8, 3, 2],
            vec![8, 2, 0],
        ];
        Polyhedron::from_faces(&points, &faces).expect("a polyhedron")
    }

    #[test]
    fn corners_are_sharp_and_what_a_mesh_adds_to_flat_faces_is_blunt() {
        for bend in [1e-6, 1e-4, 1e-2] {
            let body = roofed(0.5 * bend, 0.5 * bend);
            let sharp = Sharpness::of(&body);
            assert_eq!(sharp.of_vertex(VertexId(0)), 1.0);
            for blunt in [8, 9] {
                let found = f64::from(sharp.of_vertex(VertexId(blunt)));
                assert!(found > 0.5 * bend / EDGE && found < 4.0 * bend / EDGE, "{bend}: vertex {blunt} {found}");
            }
            for e in body.edges() {
                let between = body.edge(e).vertices;
                let on_top = between.contains(&VertexId(8));
                let found = f64::from(sharp.of_edge(e));
                assert!(if on_top { found < 4.0 * bend / EDGE } else { found > 0.0 }, "{bend}: {between:?} {found}");
            }
        }
    }
}
