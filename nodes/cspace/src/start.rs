use crate::BasicContact;
use crate::body::Spoke;
use crate::c_face::{type_a, type_b, type_c};
use crate::crossing::first_crossing;
use crate::ids::NO_EDGE;
use crate::placed::Placed;
use spatial::DVec3;

impl Placed<'_> {
    /// A node next to the unit direction `m` (axes of W), where vertices `va` and `vb` support the two bodies, with
    /// no smaller signed distance than `m` has: out of the overlaid cell along the gradient, then along its border.
    pub(crate) fn node_from_direction(&self, m: DVec3, va: u32, vb: u32) -> BasicContact {
        let w = self.point_in_w(self.a.points[va as usize]) - self.b.points[vb as usize];
        let mut d = w - m * m.dot(w);
        if !(d.length_squared() > 1e-24 * w.length_squared()) {
            d = m.any_orthonormal_vector();
        }
        let exit_b = exit(self.b.spokes(vb), -m, -d);
        let exit_a = exit(self.a.spokes(va), self.turn_to_a(m), self.turn_to_a(d));
        if exit_b.1 <= exit_a.1 {
            if exit_b.0 == NO_EDGE {
                return type_b(va, self.b.face_of_vertex[vb as usize]);
            }
            let n = (m + d * exit_b.1).normalize();
            let faces = self.b.rods[exit_b.0 as usize].faces;
            // Along B's arc, uphill.
            let ends = faces.map(|f| self.b.planes[f as usize].0);
            let up = usize::from((ends[1] - ends[0]).dot(w - n * n.dot(w)) > 0.0);
            match first_crossing(self.a.spokes(va), self.turn_to_a(n), self.turn_to_a(ends[up]), NO_EDGE) {
                None => type_b(va, faces[up]),
                Some((e, _)) => type_c(e, exit_b.0),
            }
        } else {
            let n = (m + d * exit_a.1).normalize();
            let faces = self.a.rods[exit_a.0 as usize].faces;
            let ends = faces.map(|f| -self.turn_to_w(self.a.normals_turned[f as usize]));
            let up = usize::from((ends[1] - ends[0]).dot(w - n * n.dot(w)) > 0.0);
            match first_crossing(self.b.spokes(vb), -n, -ends[up], NO_EDGE) {
                None => type_a(faces[up], vb),
                Some((e, _)) => type_c(exit_a.0, e),
            }
        }
    }
}

/// Where a ray from `m` along `d` leaves a vertex' cell: the edge and the parameter.
fn exit(spokes: &[Spoke], m: DVec3, d: DVec3) -> (u32, f64) {
    let mut out = (NO_EDGE, f64::INFINITY);
    for s in spokes {
        let slope = d.dot(s.to);
        if slope < 0.0 {
            let t = m.dot(s.to).max(0.0) / -slope;
            if t < out.1 {
                out = (s.edge, t);
            }
        }
    }
    out
}
