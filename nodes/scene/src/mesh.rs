use spatial::{DVec3, Pose};
use std::collections::{HashMap, HashSet};

/// A surface as a file has it: polygons over shared vertices, counter-clockwise seen from outside. Not yet known to be
/// closed, planar or convex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, in the unit of the file.
    pub vertices: Vec<DVec3>,
    /// Vertex indices of each polygon, at least three.
    pub faces: Vec<Vec<u32>>,
}

/// Why a mesh cannot be read, and in which line of a text file (from 1).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    /// Line of a text file; `None` for binary files and for what concerns the file as a whole.
    pub line: Option<u64>,
    /// What is wrong.
    pub reason: String,
}

impl MeshError {
    /// An error in line `line` (from 1).
    pub fn at(line: u64, reason: impl Into<String>) -> Self {
        Self { line: Some(line), reason: reason.into() }
    }

    /// An error of the file as a whole.
    pub fn whole(reason: impl Into<String>) -> Self {
        Self { line: None, reason: reason.into() }
    }
}

impl std::fmt::Display for MeshError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}: {}", self.reason),
            None => f.write_str(&self.reason),
        }
    }
}

impl std::error::Error for MeshError {}

impl Mesh {
    /// The mesh with vertices at exactly equal positions made one: exporters write a vertex once for every face.
    /// Polygons keep their order; corners that fall together are dropped, and with them faces of less than three.
    #[must_use]
    pub fn welded(&self) -> Self {
        let mut index_of: HashMap<[u64; 3], u32> = HashMap::with_capacity(self.vertices.len());
        let mut welded = Self::default();
        let new_index: Vec<u32> = self
            .vertices
            .iter()
            .map(|v| {
                *index_of.entry(position_bits(*v)).or_insert_with(|| {
                    welded.vertices.push(*v);
                    (welded.vertices.len() - 1) as u32
                })
            })
            .collect();
        for face in &self.faces {
            let mut corners: Vec<u32> = face.iter().map(|&i| new_index[i as usize]).collect();
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            if corners.len() >= 3 {
                welded.faces.push(corners);
            }
        }
        welded
    }

    /// The mesh without faces whose corners lie at fewer than three places: digits that are too few make such of slivers. A
    /// closed surface stays closed without them.
    #[must_use]
    pub fn without_collapsed_faces(&self) -> Self {
        let places = |face: &Vec<u32>| {
            face.iter().map(|&i| position_bits(self.vertices[i as usize])).collect::<HashSet<_>>().len()
        };
        let faces = self.faces.iter().filter(|face| places(face) >= 3).cloned().collect();
        Self { vertices: self.vertices.clone(), faces }
    }

    /// The pieces of the surface that share no vertex, each as a mesh of its own, in the order of their first face.
    #[must_use]
    pub fn components(&self) -> Vec<Self> {
        let mut parent: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for face in &self.faces {
            for pair in face.windows(2) {
                let (a, b) = (root(&mut parent, pair[0]), root(&mut parent, pair[1]));
                parent[a as usize] = b;
            }
        }
        let mut component_of: HashMap<u32, usize> = HashMap::new();
        let mut components: Vec<(Self, HashMap<u32, u32>)> = Vec::new();
        for face in &self.faces {
            let c = *component_of.entry(root(&mut parent, face[0])).or_insert_with(|| {
                components.push(Default::default());
                components.len() - 1
            });
            let (mesh, local) = &mut components[c];
            let corners = face
                .iter()
                .map(|&i| {
                    *local.entry(i).or_insert_with(|| {
                        mesh.vertices.push(self.vertices[i as usize]);
                        (mesh.vertices.len() - 1) as u32
                    })
                })
                .collect();
            mesh.faces.push(corners);
        }
        components.into_iter().map(|(mesh, _)| mesh).collect()
    }

    /// The mesh scaled about the origin, then moved.
    #[must_use]
    pub fn transformed(&self, pose: &Pose, scale: DVec3) -> Self {
        let vertices = self.vertices.iter().map(|v| pose.transform_point(*v * scale)).collect();
        Self { vertices, faces: self.faces.clone() }
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: &Self) {
        let offset = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.faces.extend(other.faces.iter().map(|f| f.iter().map(|i| i + offset).collect()));
    }

    /// Signed volume: positive when the faces point outwards.
    #[must_use]
    pub fn volume(&self) -> f64 {
        // About the first vertex: about a far origin the terms would cancel badly.
        let origin = self.vertices.first().copied().unwrap_or_default();
        self.triangles().map(|[a, b, c]| (a - origin).dot((b - origin).cross(c - origin)) / 6.0).sum()
    }

    /// Diagonal of the bounding box.
    #[must_use]
    pub fn size(&self) -> f64 {
        let low = self.vertices.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = self.vertices.iter().copied().reduce(DVec3::max).unwrap_or_default();
        (high - low).length()
    }

    /// The face that runs along each directed side; of several the last.
    pub(crate) fn face_at_sides(&self) -> HashMap<(u32, u32), usize> {
        let sides = |(f, face): (usize, &Vec<u32>)| {
            let next = face.iter().copied().cycle().skip(1);
            face.iter().copied().zip(next).map(|side| (side, f)).collect::<Vec<_>>()
        };
        self.faces.iter().enumerate().flat_map(sides).collect()
    }

    /// The faces as fans of triangles.
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.faces.iter().flat_map(move |face| {
            let at = move |i: usize| self.vertices[face[i] as usize];
            (1..face.len() - 1).map(move |i| [at(0), at(i), at(i + 1)])
        })
    }
}

/// Equal positions have equal bits: adding zero turns -0.0 into 0.0.
pub(crate) fn position_bits(v: DVec3) -> [u64; 3] {
    (v + DVec3::ZERO).to_array().map(f64::to_bits)
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn welding_joins_equal_positions_and_drops_what_collapses() {
        let soup = Mesh {
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(-0.0, 0.0, 0.0), DVec3::X, DVec3::Z],
            faces: vec![vec![0, 1, 2], vec![3, 5, 4], vec![0, 3, 1]],
        };
        let welded = soup.welded();
        assert_eq!(welded.vertices.len(), 4);
        assert_eq!(welded.faces, vec![vec![0, 1, 2], vec![0, 3, 1]]);
    }

    #[test]
    fn components_share_no_vertex() {
        let mesh = Mesh {
            vertices: (0..7).map(|i| DVec3::splat(f64::from(i))).collect(),
            faces: vec![vec![0, 1, 2], vec![4, 5, 6], vec![2, 3, 0]],
        };
        let components = mesh.components();
        assert_eq!(components.iter().map(|c| c.faces.len()).collect::<Vec<_>>(), vec![2, 1]);
        assert_eq!(components[1].vertices[0], DVec3::splat(4.0));
    }
}
