use crate::pairs::Pairs;
use cspace::{BasicContact, CFacePolygon, World};
use haptics::ContactFormation;
use spatial::Pose;

/// What a C-face is to `x` right now, most telling first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    /// A contact takes place on it.
    Touching,
    /// The C-face of a pair in contact, or else of the nearest pair, that is nearest to `x`.
    Near,
    /// Of the local subgraph (paper, section II.A): shares an edge with Near.
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
    /// Its faces; of large bodies those around Near.
    pub faces: Vec<CFacePolygon>,
    /// Whether these are all.
    pub whole: bool,
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
pub(crate) fn slice(
    world: &World,
    pairs: &mut Pairs,
    pose: &Pose,
    formation: &ContactFormation,
    reach: f64,
) -> Vec<PairSlice> {
    let mut slices = Vec::new();
    for (part, a) in world.moving.iter().enumerate() {
        let center = pose.transform_point(a.center());
        for (piece, fixed) in world.fixed.iter().enumerate() {
            let contacts =
                formation.points().iter().filter(|p| p.part_a as usize == part && p.piece_b as usize == piece);
            let touching: Vec<_> = contacts.map(|p| p.contact).collect();
            let b = &fixed.polyhedron;
            if touching.is_empty() && center.distance(b.center()) - a.size() - b.size() > reach {
                continue;
            }
            let far = if touching.is_empty() { reach } else { f64::INFINITY };
            let faces = pairs.polygons(world, (part, piece), pose, far);
            if let Some(slice) = classify((part, piece), faces, pairs.is_whole(part, piece), pose, &touching)
                && (slice.distance < reach || !touching.is_empty())
            {
                slices.push(slice);
            }
        }
    }
    quiet(&mut slices);
    slices
}

/// Near and its local subgraph are told apart in the pairs that touch alone, or else in the nearest: the others' would
/// hide them.
fn quiet(slices: &mut [PairSlice]) {
    let touches = |s: &PairSlice| s.roles.contains(&Role::Touching);
    let nearest = slices.iter().map(|s| s.distance).fold(f64::INFINITY, f64::min);
    let any = slices.iter().any(touches);
    for slice in slices.iter_mut() {
        let told = if any { touches(slice) } else { slice.distance == nearest };
        if !told {
            slice.roles.fill(Role::Other);
        }
    }
}

fn classify(
    (part, piece): (usize, usize),
    faces: Vec<CFacePolygon>,
    whole: bool,
    pose: &Pose,
    touching: &[BasicContact],
) -> Option<PairSlice> {
    let distances: Vec<f64> = faces.iter().map(|f| f.distance(pose.translation)).collect();
    let near = (0..faces.len()).max_by(|&i, &j| distances[i].total_cmp(&distances[j]))?;
    let role = |i: usize| {
        let face = &faces[i];
        if face.contacts.iter().any(|c| touching.contains(c)) {
            Role::Touching
        } else if i == near {
            Role::Near
        } else if faces[near].is_neighbor(face) {
            Role::Local
        } else {
            Role::Other
        }
    };
    let roles = (0..faces.len()).map(role).collect();
    let distance = distances[near];
    Some(PairSlice { part, piece, faces, whole, roles, near, distance })
}
