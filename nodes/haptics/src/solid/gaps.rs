//! Gaps between pieces of one body that are too narrow to be meant, closed before anything is felt.

use cspace::{EdgeId, FaceId, FixedPart, Polyhedron, World};
use glam::DMat3;
use spatial::DVec3;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Widths of gaps that are closed, as parts of the largest piece: files of six or seven digits leave such between pieces that
/// were one. What is narrower counts as closed in any case.
const NARROWEST: f64 = 1e-8;
const WIDEST: f64 = 3e-5;
/// Wider ones may be meant however large the pieces are, metres.
const MEANT: f64 = 2e-6;
/// Cosine between two faces up to which they face each other across a gap.
const OPPOSITE: f64 = -0.999_999;
/// Determinant of the normals at a vertex above which it is told well where they meet.
const SHARP: f64 = 0.05;

/// The world with its gaps closed: the tip of a part would fall into them.
pub(crate) fn closed(world: Arc<World>) -> Arc<World> {
    let pieces: Vec<_> = world.fixed.iter().map(|p| p.polyhedron.clone()).collect();
    match (closed_pieces(&world.moving), closed_pieces(&pieces)) {
        (None, None) => world,
        (moving, fixed) => {
            let fixed = fixed.unwrap_or(pieces).into_iter().zip(&world.fixed);
            let fixed = fixed.map(|(polyhedron, old)| FixedPart { polyhedron, obstacle: old.obstacle }).collect();
            Arc::new(World { moving: moving.unwrap_or_else(|| world.moving.clone()), fixed })
        }
    }
}

/// The pieces of a rigid assembly, in one common frame, one of the two at each gap moved up to the other. None if there are no gaps.
fn closed_pieces(pieces: &[Arc<Polyhedron>]) -> Option<Vec<Arc<Polyhedron>>> {
    let size = pieces.iter().map(|p| p.size()).fold(0.0, f64::max);
    let widths = NARROWEST * size..=(WIDEST * size).min(MEANT);
    let mut ways: Vec<Vec<f64>> = pieces.iter().map(|p| vec![0.0; p.face_count()]).collect();
    for (a, p) in pieces.iter().enumerate() {
        for (b, q) in pieces.iter().enumerate().skip(a + 1) {
            if p.center().distance(q.center()) > p.size() + q.size() + widths.end() {
                continue;
            }
            for f in p.faces() {
                let Some(g) = face_across(p, f, q, &widths) else { continue };
                let mut either = [(a, p, f, q, g), (b, q, g, p, f)];
                // What moves is no surface of the solid if the other face is all over it.
                if !is_under(p, f, q, g, *widths.end()) && is_under(q, g, p, f, *widths.end()) {
                    either.reverse();
                }
                let Some((piece, p, f, q, g)) = either.into_iter().find(|(_, p, f, ..)| may_move(p, *f)) else {
                    continue;
                };
                let known = &mut ways[piece][f.index()];
                *known = known.max(farthest(p, f, q, g));
            }
        }
    }
    let grown = |(p, ways): (&Arc<Polyhedron>, &Vec<f64>)| {
        let grown = if ways.iter().any(|w| *w > 0.0) { grown(p, ways) } else { None };
        grown.map_or_else(|| (p.clone(), false), |p| (Arc::new(p), true))
    };
    let (closed, changed): (Vec<_>, Vec<_>) = pieces.iter().zip(&ways).map(grown).unzip();
    changed.contains(&true).then_some(closed)
}

/// The face of `q` that lies across a gap from `face` of `p`, if there is a gap.
fn face_across(p: &Polyhedron, face: FaceId, q: &Polyhedron, widths: &RangeInclusive<f64>) -> Option<FaceId> {
    let plane = p.face_plane(face);
    let nearest = q.support(-plane.normal);
    // Rounding turns faces, too: a gap may be closed at one end.
    if plane.signed_distance(q.vertex(nearest)).abs() > *widths.end() {
        return None;
    }
    let lies_over = |g: &FaceId| {
        let is_beside = |p: &Polyhedron, f, q: &Polyhedron, g| {
            let outside = |side: &cspace::Plane| {
                q.face_vertices(g).iter().all(|v| side.signed_distance(q.vertex(*v)) >= -widths.end())
            };
            p.face_sides(f).iter().any(outside)
        };
        q.face_plane(*g).normal.dot(plane.normal) < OPPOSITE
            && widths.contains(&farthest(p, face, q, *g))
            && !is_beside(p, face, q, *g)
            && !is_beside(q, *g, p, face)
    };
    q.vertex_faces(nearest).iter().copied().find(lies_over)
}

/// Whether all of a face of `p` lies under the one of `q` across the gap, but for `slack` metres at its sides.
fn is_under(p: &Polyhedron, face: FaceId, q: &Polyhedron, other: FaceId, slack: f64) -> bool {
    let inside =
        |side: &cspace::Plane| p.face_vertices(face).iter().all(|v| side.signed_distance(p.vertex(*v)) <= slack);
    q.face_sides(other).iter().all(inside)
}

/// How far over a face of `p` the vertices of one of `q` lie at most, metres.
fn farthest(p: &Polyhedron, face: FaceId, q: &Polyhedron, other: FaceId) -> f64 {
    let plane = p.face_plane(face);
    q.face_vertices(other).iter().map(|v| plane.signed_distance(q.vertex(*v))).fold(0.0, f64::max)
}

/// Whether the face can be moved outward with nothing but its own vertices.
fn may_move(p: &Polyhedron, face: FaceId) -> bool {
    p.face_vertices(face).iter().all(|v| match p.vertex_faces(*v) {
        [f, g, h] => normals(p, [*f, *g, *h]).determinant().abs() > SHARP,
        _ => false,
    })
}

fn normals(p: &Polyhedron, faces: [FaceId; 3]) -> DMat3 {
    let [f, g, h] = faces.map(|f| p.face_plane(f).normal);
    DMat3::from_cols(f, g, h).transpose()
}

/// The piece with its faces moved outward by `ways`, metres; its faces and edges keep their numbers.
fn grown(p: &Polyhedron, ways: &[f64]) -> Option<Polyhedron> {
    let mut vertices = p.vertices().to_vec();
    for v in p.corner_ids() {
        if let [f, g, h] = *p.vertex_faces(v) {
            let ways = DVec3::new(ways[f.index()], ways[g.index()], ways[h.index()]);
            if ways != DVec3::ZERO {
                vertices[v.index()] += normals(p, [f, g, h]).inverse() * ways;
            }
        }
    }
    let rings: Vec<Vec<u32>> = p.faces().map(|f| p.face_vertices(f).iter().map(|v| v.0).collect()).collect();
    let grown = Polyhedron::from_faces(&vertices, &rings).ok()?;
    let same_edges = |e: EdgeId| grown.edge(e) == p.edge(e);
    (grown.face_count() == p.face_count() && grown.edge_count() == p.edge_count() && p.edges().all(same_edges))
        .then_some(grown)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::cuboid;

    fn row_of(gap: f64) -> Vec<Arc<Polyhedron>> {
        // Three in a row, and one beside the second that reaches past its end.
        vec![
            Arc::new(cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(0.0, 1.0, 0.0))),
            Arc::new(cuboid(DVec3::new(gap, -1.0, -1.0), DVec3::new(1.0, 1.0, 0.0))),
            Arc::new(cuboid(DVec3::new(1.0 + gap, -1.0, -1.0), DVec3::new(2.0, 1.0, 0.5))),
            Arc::new(cuboid(DVec3::new(0.5, 1.0 + gap, -1.0), DVec3::new(1.5, 2.0, 0.0))),
        ]
    }

    #[test]
    fn pieces_move_up_to_each_other_and_nothing_else_changes() {
        for gap in [1e-7, 1e-6, 1.9e-6] {
            let pieces = row_of(gap);
            let closed = closed_pieces(&pieces).expect("gaps");
            let span = |p: &Polyhedron| {
                let all = |pick: fn(DVec3, DVec3) -> DVec3| p.vertices().iter().copied().reduce(pick).unwrap();
                [all(DVec3::min), all(DVec3::max)]
            };
            let expected = [
                [DVec3::new(-1.0, -1.0, -1.0), DVec3::new(gap, 1.0, 0.0)],
                [DVec3::new(gap, -1.0, -1.0), DVec3::new(1.0 + gap, 1.0 + gap, 0.0)],
                [DVec3::new(1.0 + gap, -1.0, -1.0), DVec3::new(2.0, 1.0 + gap, 0.5)],
                [DVec3::new(0.5, 1.0 + gap, -1.0), DVec3::new(1.5, 2.0, 0.0)],
            ];
            for (found, expected) in closed.iter().zip(expected) {
                for (f, e) in span(found).into_iter().zip(expected) {
                    assert!(f.distance(e) < 1e-15, "{gap}: {f}, not {e}");
                }
            }
        }
    }

    #[test]
    fn pieces_that_touch_or_stand_apart_stay_as_they_are() {
        for gap in [0.0, 1e-9, 3e-6, 0.1] {
            assert!(closed_pieces(&row_of(gap)).is_none(), "{gap}");
        }
    }

    #[test]
    fn the_face_moves_that_the_other_covers() {
        let wall = Arc::new(cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(0.0, 1.0, 1.0)));
        let block = Arc::new(cuboid(DVec3::new(1e-6, -0.1, -0.1), DVec3::new(0.2, 0.1, 0.1)));
        for pieces in [[wall.clone(), block.clone()], [block, wall]] {
            let closed = closed_pieces(&pieces).expect("a gap");
            for (new, old) in closed.iter().zip(&pieces) {
                let is_wall = old.size() > 1.0;
                assert_eq!(new.vertices() == old.vertices(), is_wall);
                assert!(is_wall || new.vertices().iter().any(|v| v.x.abs() < 1e-15));
            }
        }
    }
}
