use cspace::{FaceId, Polyhedron};
use glam::DVec3;
use rerun::{LineStrips3D, Mesh3D, Rgba32};

/// Flat polygons on their way to rerun, as `f32`: flat-shaded triangles and outlines.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    outlines: Vec<Vec<[f32; 3]>>,
}

impl Surface {
    /// The faces of a polyhedron, in its own coordinates, metres.
    pub(crate) fn of(polyhedron: &Polyhedron) -> Self {
        let mut surface = Self::default();
        surface.add(polyhedron);
        surface
    }

    pub(crate) fn add(&mut self, polyhedron: &Polyhedron) {
        for face in (0..polyhedron.face_count() as u32).map(FaceId) {
            let corners: Vec<DVec3> =
                polyhedron.face_vertices(face).iter().map(|v| polyhedron.vertices()[v.index()]).collect();
            self.push(&corners, polyhedron.face_plane(face).normal);
        }
    }

    /// Adds a convex polygon: corners counter-clockwise seen from the tip of `normal`.
    pub(crate) fn push(&mut self, corners: &[DVec3], normal: DVec3) {
        self.fill(corners, normal);
        self.line(corners.iter().chain(corners.first()));
    }

    /// Adds the area of a convex polygon.
    pub(crate) fn fill(&mut self, corners: &[DVec3], normal: DVec3) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners.iter().map(|c| c.as_vec3().to_array()));
        self.normals.extend(std::iter::repeat_n(normal.as_vec3().to_array(), corners.len()));
        let fan = (1..(corners.len() as u32).saturating_sub(1)).map(|i| [first, first + i, first + i + 1]);
        self.triangles.extend(fan);
    }

    /// Adds an edge.
    pub(crate) fn line<'p>(&mut self, points: impl IntoIterator<Item = &'p DVec3>) {
        self.outlines.push(points.into_iter().map(|c| c.as_vec3().to_array()).collect());
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The corners of its triangles.
    #[cfg(test)]
    pub(crate) fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        let corner = |i: u32| DVec3::from_array(self.positions[i as usize].map(f64::from));
        self.triangles.iter().map(move |t| t.map(corner))
    }

    /// Its edges.
    #[cfg(test)]
    pub(crate) fn lines(&self) -> impl Iterator<Item = Vec<DVec3>> + '_ {
        self.outlines.iter().map(|line| line.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect())
    }

    /// Bytes that it takes in a file, before compression.
    pub(crate) fn bytes(&self) -> usize {
        let outline: usize = self.outlines.iter().map(|o| 12 * o.len() + 4).sum();
        24 * self.positions.len() + 12 * self.triangles.len() + outline
    }

    /// As a filled mesh in one colour; the alpha of the colour counts.
    pub(crate) fn mesh(&self, color: Rgba32) -> Mesh3D {
        Mesh3D::new(self.positions.iter().copied())
            .with_vertex_normals(self.normals.iter().copied())
            .with_triangle_indices(self.triangles.iter().copied())
            // Per-vertex alpha is ignored by the viewer: transparency goes through the albedo.
            .with_albedo_factor(color)
    }

    /// Its edges, as lines of `width` points on the screen.
    pub(crate) fn edges(&self, color: Rgba32, width: f32) -> LineStrips3D {
        LineStrips3D::new(self.outlines.iter().cloned())
            .with_colors([color])
            .with_radii([rerun::components::Radius::new_ui_points(width / 2.0)])
    }
}
