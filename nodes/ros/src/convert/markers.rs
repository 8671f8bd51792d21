use super::{header, point, pose, vector};
use cspace::{Polyhedron, World};
use r2r::builtin_interfaces::msg::Duration;
use r2r::geometry_msgs::msg::Point;
use r2r::std_msgs::msg::ColorRGBA;
use r2r::visualization_msgs::msg::{Marker, MarkerArray};
use servo::TickRecord;
use spatial::{DVec3, Pose, Stamp};

/// Colours by meaning, the same as in the rerun pictures' legend as far as RViz can show them: r, g, b, a.
const OBSTACLE: [f32; 4] = [0.55, 0.58, 0.62, 0.5];
const HAND: [f32; 4] = [0.25, 0.55, 0.95, 0.35];
const PROXY: [f32; 4] = [0.95, 0.62, 0.15, 0.9];
const CONTACT: [f32; 4] = [0.9, 0.15, 0.2, 1.0];
const FORCE: [f32; 4] = [0.2, 0.75, 0.3, 1.0];

const ARROW: i32 = 0;
const SPHERE_LIST: i32 = 7;
const LINE_LIST: i32 = 5;
const TRIANGLE_LIST: i32 = 11;
/// Length of the arrow of 1 N, metres.
const METRES_PER_NEWTON: f64 = 0.01;

/// The bodies, the contacts and the force for RViz. The meshes are triangulated once.
pub struct MarkerPainter {
    moving: Vec<Point>,
    fixed: Vec<Point>,
    size: f64,
    frame_id: String,
}

impl MarkerPainter {
    /// For the bodies of a scene, in the world frame `frame_id`.
    #[must_use]
    pub fn new(world: &World, frame_id: &str) -> Self {
        let triangles = |p: &Polyhedron| fan(p);
        let size = world.moving.iter().flat_map(|p| p.vertices().iter()).map(|v| v.length()).fold(1e-3, f64::max);
        Self {
            moving: world.moving.iter().flat_map(|p| triangles(p)).collect(),
            fixed: world.fixed.iter().flat_map(|f| triangles(&f.polyhedron)).collect(),
            size,
            frame_id: frame_id.to_owned(),
        }
    }

    /// What moves with every picture: the hand's part, the proxy's, the contacts and the force.
    #[must_use]
    pub fn moving(&self, tick: &TickRecord) -> MarkerArray {
        let at = tick.input.stamp;
        let mut contacts = Marker { points: Vec::new(), ..self.marker(at, "contacts", SPHERE_LIST, CONTACT) };
        contacts.scale = vector(DVec3::splat(0.06 * self.size));
        let mut normals = self.marker(at, "normals", LINE_LIST, CONTACT);
        normals.scale.x = 0.015 * self.size;
        for c in tick.formation.points() {
            contacts.points.push(point(c.point_w));
            normals.points.push(point(c.point_w));
            normals.points.push(point(c.point_w + c.normal_w * 0.3 * self.size));
        }
        let mut force = self.marker(at, "force", ARROW, FORCE);
        let from = tick.hip.translation;
        force.points = vec![point(from), point(from + tick.out_wrench.force * METRES_PER_NEWTON)];
        force.scale = vector(DVec3::new(0.03, 0.06, 0.0) * self.size);
        // An arrow of no length is an error to RViz.
        if tick.out_wrench.force.length() * METRES_PER_NEWTON < 1e-4 {
            force.action = 2;
        }
        let body = |name, color, at_pose: &Pose| Marker {
            pose: pose(at_pose),
            points: self.moving.clone(),
            ..self.marker(at, name, TRIANGLE_LIST, color)
        };
        let mut markers = vec![body("hand", HAND, &tick.hip), body("proxy", PROXY, &tick.proxy), force];
        for mut list in [contacts, normals] {
            // A list without points is an error to RViz too: delete what was there.
            if list.points.is_empty() {
                list.action = 2;
            }
            markers.push(list);
        }
        MarkerArray { markers }
    }

    /// What stands still.
    #[must_use]
    pub fn standing(&self, at: Stamp) -> MarkerArray {
        MarkerArray {
            markers: vec![Marker {
                points: self.fixed.clone(),
                ..self.marker(at, "obstacles", TRIANGLE_LIST, OBSTACLE)
            }],
        }
    }

    fn marker(&self, at: Stamp, ns: &str, type_: i32, [r, g, b, a]: [f32; 4]) -> Marker {
        Marker {
            header: header(at, &self.frame_id),
            ns: ns.to_owned(),
            id: 0,
            type_,
            action: 0,
            pose: pose(&Pose::IDENTITY),
            scale: vector(DVec3::ONE),
            color: ColorRGBA { r, g, b, a },
            lifetime: Duration { sec: 0, nanosec: 0 },
            ..Default::default()
        }
    }
}

/// The faces as triangles, counter-clockwise from outside.
fn fan(p: &Polyhedron) -> Vec<Point> {
    let mut out = Vec::new();
    for face in p.faces() {
        let corners: Vec<DVec3> = p.face_vertices(face).iter().map(|v| p.vertex(*v)).collect();
        for pair in corners.windows(2).skip(1) {
            out.extend([point(corners[0]), point(pair[0]), point(pair[1])]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_is_twelve_triangles_facing_out() {
        let corners: Vec<DVec3> =
            (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) - 0.5).collect();
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|f| f.to_vec());
        let cube = Polyhedron::from_faces(&corners, &faces).unwrap();
        let triangles = fan(&cube);
        assert_eq!(triangles.len(), 36);
        for t in triangles.chunks(3) {
            let [a, b, c] = [&t[0], &t[1], &t[2]].map(|p| DVec3::new(p.x, p.y, p.z));
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
        }
    }
}
