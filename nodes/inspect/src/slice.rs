use cspace::{BasicContact, CFacePolygon, ContactGraph, World, c_face_polygons};
use haptics::ContactFormation;
use spatial::Pose;
use std::collections::BTreeSet;

/// What a C-face is to `x` right now, most telling first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    /// A contact takes place on it.
    Touching,
    /// The C-face of its pair that is nearest to `x`.
    Near,
    /// Of the local subgraph: neighbour of Near.
    Local,
    /// Applicable at this orientation, no more.
    Other,
}

impl Role {
    pub(crate) const ALL: [Self; 4] = [Self::Touching, Self::Near, Self::Local, Self::Other];
}

/// The C-obstacle of one pair at the present orientation.
#[derive(Clone, Debug)]
pub(crate) struct PairSlice {
    /// Index in `World::moving`.
    pub part: usize,
    /// Index in `World::fixed`.
    pub piece: usize,
    /// Its faces.
    pub faces: Vec<CFacePolygon>,
    /// The role of each face.
    pub roles: Vec<Role>,
    /// Index of Near.
    pub near: usize,
    /// Signed distance of `x` to Near's plane, metres, `< 0` inside.
    pub distance: f64,
}

/// The slice of C-space at the orientation of `pose`: every pair whose C-obstacle is within `reach` (metres) of `x`.
///
/// Taken at the proxy's pose, `x` is the SCP: it lies on the C-faces of the contacts that take place, and the force
/// leaves them along their normals.
pub(crate) fn slice(world: &World, pose: &Pose, formation: &ContactFormation, reach: f64) -> Vec<PairSlice> {
    let mut slices = Vec::new();
    for (part, a) in world.moving.iter().enumerate() {
        for (piece, fixed) in world.fixed.iter().enumerate() {
            let faces = c_face_polygons(a, &fixed.polyhedron, pose.rotation);
            let contacts =
                formation.points().iter().filter(|p| p.part_a as usize == part && p.piece_b as usize == piece);
            let touching: Vec<_> = contacts.map(|p| p.contact).collect();
            let graph = ContactGraph::new(a, &fixed.polyhedron);
            if let Some(slice) = classify(part, piece, faces, pose, &touching, &graph)
                && (slice.distance < reach || !touching.is_empty())
            {
                slices.push(slice);
            }
        }
    }
    slices
}

fn classify(
    part: usize,
    piece: usize,
    faces: Vec<CFacePolygon>,
    pose: &Pose,
    touching: &[BasicContact],
    graph: &ContactGraph<'_>,
) -> Option<PairSlice> {
    let distances: Vec<f64> = faces.iter().map(|f| f.distance(pose.translation)).collect();
    let near = (0..faces.len()).max_by(|&i, &j| distances[i].total_cmp(&distances[j]))?;
    // The local subgraph: Near and its applicable G-neighbours (paper, section III, step 2a).
    let local: BTreeSet<BasicContact> = faces[near].contacts.iter().flat_map(|c| graph.neighbors(*c)).collect();
    let role = |i: usize| {
        let face = &faces[i];
        if face.contacts.iter().any(|c| touching.contains(c)) {
            Role::Touching
        } else if i == near {
            Role::Near
        } else if face.contacts.iter().any(|c| local.contains(c)) {
            Role::Local
        } else {
            Role::Other
        }
    };
    let roles = (0..faces.len()).map(role).collect();
    let distance = distances[near];
    Some(PairSlice { part, piece, faces, roles, near, distance })
}
