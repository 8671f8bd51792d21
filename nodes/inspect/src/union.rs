use crate::surface::Surface;
use cspace::{CFacePolygon, cut_out, polygon_area};
use glam::DVec3;

/// A part of the C-obstacles' size: what is nearer than this to a surface counts as on it.
const ON_SURFACE: f64 = 1e-7;
/// Normals that differ by less (radians) are of coplanar C-faces, if these lie on each other.
const COPLANAR: f64 = 1e-6;
/// Planes that polygons are held against for one picture; what is left then is drawn whole.
const MOST_CUTS: usize = 100_000;
/// Of less than this part of a C-face it cannot be told which it is.
const HARDLY_SHOWN: f64 = 0.2;

/// The C-faces of one pair.
pub(crate) struct Obstacle<'p> {
    /// The polygons, and the surface that each goes to: where coplanar ones lie on each other, the one with the lower
    /// number is drawn.
    pub faces: Vec<(&'p CFacePolygon, usize)>,
    /// Whether these are all C-faces of the pair: only then is it known what lies inside.
    pub whole: bool,
}

/// What shows of the C-faces from free space: the boundary of the union of the C-obstacles, each C-face without what lies
/// inside the other C-obstacles. The surfaces with the lowest numbers are cut first; C-faces of those below `outlined` keep
/// their whole outline, to be found where next to nothing of them shows.
pub(crate) fn surfaces<const N: usize>(obstacles: &[Obstacle<'_>], outlined: usize) -> [Surface; N] {
    let mut surfaces: [Surface; N] = std::array::from_fn(|_| Surface::default());
    let corners = obstacles.iter().flat_map(|o| &o.faces).flat_map(|(face, _)| &face.vertices);
    let boxes: Vec<Bounds> = obstacles.iter().map(|o| Bounds::of(o.faces.iter().flat_map(|f| &f.0.vertices))).collect();
    let Some(origin) = corners.clone().next() else { return surfaces };
    let tolerance = ON_SURFACE * corners.map(|c| c.distance(*origin)).fold(0.0, f64::max);
    let mut order: Vec<(usize, usize, &CFacePolygon)> = Vec::new();
    for (index, obstacle) in obstacles.iter().enumerate() {
        order.extend(obstacle.faces.iter().map(|(face, surface)| (*surface, index, *face)));
    }
    order.sort_by_key(|(surface, index, _)| (*surface, *index));
    let mut cuts = 0;
    for (number, index, face) in order {
        let around = Bounds::of(&face.vertices);
        let mut cutters = Vec::new();
        for (other, obstacle) in obstacles.iter().enumerate() {
            if other == index || !obstacle.whole || !boxes[other].meets(&around, tolerance) {
                continue;
            }
            cuts += obstacle.faces.len();
            cutters.push(Cutter::new(obstacle, (number, index), other, face.normal_w, tolerance));
        }
        let surface = &mut surfaces[number];
        if cutters.is_empty() || cuts > MOST_CUTS {
            surface.push(&face.vertices, face.normal_w);
        } else {
            draw(surface, face, &cutters, tolerance, number < outlined);
        }
    }
    surfaces
}

/// Half-spaces whose intersection is cut out of a C-face: normal and offset.
struct Cutter(Vec<(DVec3, f64)>);

impl Cutter {
    /// Cuts a C-face a little outside of it, so that two obstacles that touch there cover each other's side.
    fn new(obstacle: &Obstacle<'_>, rank: (usize, usize), index: usize, normal: DVec3, tolerance: f64) -> Self {
        let half_space = |(face, number): &(&CFacePolygon, usize)| {
            let coplanar = face.normal_w.distance(normal) < COPLANAR;
            // Of two coplanar C-faces one covers the other.
            let lift = if coplanar && (*number, index) < rank { 0.0 } else { 4.0 * tolerance };
            (face.normal_w, face.offset + tolerance - lift * face.normal_w.dot(normal))
        };
        Self(obstacle.faces.iter().map(half_space).collect())
    }

    fn heights(&self) -> Vec<impl Fn(DVec3) -> f64> {
        self.0.iter().map(|&(normal, offset)| move |p: DVec3| normal.dot(p) - offset).collect()
    }

    /// The parts of a segment outside.
    fn outside(&self, [from, to]: [DVec3; 2]) -> Vec<[DVec3; 2]> {
        let (mut enters, mut leaves) = (0.0, 1.0);
        for (normal, offset) in &self.0 {
            let (h, step) = (normal.dot(from) - offset, normal.dot(to - from));
            if step < 0.0 {
                enters = f64::max(enters, -h / step);
            } else if step > 0.0 {
                leaves = f64::min(leaves, -h / step);
            } else if h > 0.0 {
                return vec![[from, to]];
            }
        }
        if enters >= leaves {
            return vec![[from, to]];
        }
        let at = |t: f64| from + (to - from) * t;
        let parts = [(enters > 0.0).then(|| [from, at(enters)]), (leaves < 1.0).then(|| [at(leaves), to])];
        parts.into_iter().flatten().collect()
    }
}

/// Draws what is left of a C-face, with the lines along which the others cut it.
fn draw(surface: &mut Surface, face: &CFacePolygon, cutters: &[Cutter], tolerance: f64, outlined: bool) {
    let ring = &face.vertices;
    let mut left = vec![ring.clone()];
    let mut edges: Vec<[DVec3; 2]> = sides(ring).collect();
    let mut cut = false;
    for (index, cutter) in cutters.iter().enumerate() {
        let heights = cutter.heights();
        let (_, hole) = cut_out(ring.clone(), &heights);
        if hole.is_empty() {
            continue;
        }
        cut = true;
        left = left.into_iter().flat_map(|part| cut_out(part, &heights).0).collect();
        edges = edges.into_iter().flat_map(|edge| cutter.outside(edge)).collect();
        // The hole's rim, where it is neither the C-face's own nor inside another C-obstacle.
        let inner = |[from, to]: &[DVec3; 2]| {
            let middle = 0.5 * (*from + *to);
            sides(ring).all(|[a, b]| (middle - a).cross((b - a).normalize_or_zero()).length() > 2.0 * tolerance)
        };
        let mut rim: Vec<[DVec3; 2]> = sides(&hole).filter(inner).collect();
        for (other, next) in cutters.iter().enumerate() {
            if other != index {
                rim = rim.into_iter().flat_map(|edge| next.outside(edge)).collect();
            }
        }
        // Not among `edges`: its own C-obstacle must not cut it.
        surface_lines(surface, &rim);
    }
    if !cut {
        surface.push(ring, face.normal_w);
        return;
    }
    left.iter().for_each(|part| surface.fill(part, face.normal_w));
    let shown: f64 = left.iter().map(|part| polygon_area(part, face.normal_w)).sum();
    if outlined && shown < HARDLY_SHOWN * face.area() {
        surface.line(ring.iter().chain(ring.first()));
    } else {
        surface_lines(surface, &edges);
    }
}

fn surface_lines(surface: &mut Surface, edges: &[[DVec3; 2]]) {
    edges.iter().for_each(|edge| surface.line(edge));
}

fn sides(ring: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> + '_ {
    (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]])
}

/// A box along the axes of W.
struct Bounds([DVec3; 2]);

impl Bounds {
    fn of<'p>(points: impl IntoIterator<Item = &'p DVec3>) -> Self {
        let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        Self(points.into_iter().fold(nothing, |[low, high], p| [low.min(*p), high.max(*p)]))
    }

    fn meets(&self, other: &Self, margin: f64) -> bool {
        let ([low, high], [other_low, other_high]) = (self.0, other.0);
        (low - margin).cmple(other_high).all() && (other_low - margin).cmple(high).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cspace::{Polyhedron, c_face_polygons};
    use glam::DQuat;

    fn cuboid(low: DVec3, high: DVec3, turn: DQuat) -> Polyhedron {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
        let corners: Vec<DVec3> = (0..8).map(|i| turn * (low + (high - low) * corner(i))).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Polyhedron::from_faces(&corners, &faces.map(|f| f.to_vec())).expect("a box")
    }

    fn drawn(obstacles: &[Vec<CFacePolygon>]) -> Surface {
        let mut owned = Vec::new();
        for faces in obstacles {
            owned.push(Obstacle { faces: faces.iter().map(|face| (face, 0)).collect(), whole: true });
        }
        let [surface] = surfaces::<1>(&owned, 0);
        surface
    }

    fn is_inside(obstacle: &[CFacePolygon], x: DVec3, margin: f64) -> bool {
        obstacle.iter().all(|face| face.distance(x) < -margin)
    }

    #[test]
    fn two_boxes_show_the_surface_of_both_together_once() {
        // A small cube against two boxes with coplanar sides: their C-obstacles are [0, 2] x [0, 2] x [0, 1] and
        // [1, 3] x [0, 2] x [0, 2], together a prism over an L of area 5 and outline 10.
        let hand = cuboid(DVec3::splat(-0.1), DVec3::splat(0.1), DQuat::IDENTITY);
        let grown = |low: DVec3, high: DVec3| cuboid(low + 0.1, high - 0.1, DQuat::IDENTITY);
        let boxes = [
            grown(DVec3::ZERO, DVec3::new(2.0, 2.0, 1.0)),
            grown(DVec3::new(1.0, 0.0, 0.0), DVec3::new(3.0, 2.0, 2.0)),
        ];
        let obstacles = boxes.map(|b| c_face_polygons(&hand, &b, DQuat::IDENTITY));
        let surface = drawn(&obstacles);
        let area: f64 = surface.triangles().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
        assert!((area - (2.0 * 5.0 + 2.0 * 10.0)).abs() < 1e-5, "{area}");
        for line in surface.lines() {
            let middle = 0.5 * (line[0] + line[1]);
            assert!(!obstacles.iter().any(|o| is_inside(o, middle, 1e-5)), "a line inside, at {middle}");
        }
    }

    #[test]
    fn what_is_drawn_is_what_lies_outside_of_the_others() {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let hand = cuboid(DVec3::new(-0.2, -0.1, -0.15), DVec3::new(0.2, 0.1, 0.15), DQuat::IDENTITY);
        let (mut shown, mut hidden) = (0, 0);
        for _ in 0..10 {
            let turn =
                |random: &mut dyn FnMut() -> f64| DQuat::from_rotation_y(random()) * DQuat::from_rotation_x(random());
            let obstacles: Vec<Vec<CFacePolygon>> = (0..4)
                .map(|_| {
                    let low = DVec3::new(random(), random(), random()) - 0.5;
                    let piece = cuboid(low, low + 0.2 + 0.6 * random(), turn(&mut random));
                    c_face_polygons(&hand, &piece, DQuat::from_rotation_z(0.3))
                })
                .collect();
            let surface = drawn(&obstacles);
            let triangles: Vec<[DVec3; 3]> = surface.triangles().collect();
            for (index, obstacle) in obstacles.iter().enumerate() {
                for face in obstacle {
                    let (i, s, t) = (1 + (random() * (face.vertices.len() - 2) as f64) as usize, random(), random());
                    let (a, b, c) = (face.vertices[0], face.vertices[i], face.vertices[i + 1]);
                    let x = a + (b - a) * s * (1.0 - t) + (c - a) * s * t;
                    let others = || obstacles.iter().enumerate().filter(|(other, _)| *other != index);
                    if others().any(|(_, o)| is_inside(o, x, -1e-4) != is_inside(o, x, 1e-4)) {
                        continue;
                    }
                    let expected = !others().any(|(_, o)| is_inside(o, x, 0.0));
                    let covering = triangles.iter().filter(|t| contains(t, x, face.normal_w)).count();
                    assert_eq!(covering > 0, expected, "at {x}");
                    if expected { shown += 1 } else { hidden += 1 }
                }
            }
        }
        assert!(shown > 100 && hidden > 100, "{shown} shown, {hidden} hidden: nothing was tested");
    }

    /// Whether `x` lies on the triangle, seen along `normal`, and the triangle across it.
    fn contains(&[a, b, c]: &[DVec3; 3], x: DVec3, normal: DVec3) -> bool {
        let on_plane = [a, b, c].iter().all(|p| (*p - x).dot(normal).abs() < 1e-6);
        on_plane && [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(x - *p).dot(normal) > -1e-7)
    }
}
