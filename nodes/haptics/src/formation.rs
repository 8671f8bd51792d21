use cspace::BasicContact;
use serde::{Deserialize, Serialize};
use spatial::DVec3;

/// The most contact points one tick carries; further ones are dropped, the deepest kept.
pub const MAX_CONTACTS: usize = 16;

/// The principal contact of the body as a whole (paper, footnote 1); the highest-dimensional one over all pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[repr(u8)]
pub enum FormationKind {
    /// No contact.
    #[default]
    Free = 0,
    /// A vertex of one body on a face of the other: one basic contact of type A or B.
    VertexFace = 1,
    /// Two crossing edges: one basic contact of type C.
    EdgeEdge = 2,
    /// An edge of one body on a face of the other (paper, Figure 4).
    EdgeFace = 3,
    /// Two faces (paper, Figure 5).
    FaceFace = 4,
}

/// Points closer together than this, metres, are one; so are a point and a line, by this part of the points' extent.
const ONE_PLACE: f64 = 1e-12;
const ON_LINE: f64 = 1e-8;

impl FormationKind {
    /// The principal contact that the basic contacts of one pair make, from their points (metres, W) seen along `normal`: one
    /// place, a line, or more. `contact` is the deepest of them.
    pub(crate) fn of(points: &[DVec3], normal: DVec3, contact: BasicContact) -> Self {
        let one = match contact {
            BasicContact::TypeC { .. } => Self::EdgeEdge,
            _ => Self::VertexFace,
        };
        let Some((first, others)) = points.split_first() else { return one };
        let farthest = others.iter().fold(DVec3::ZERO, |far, p| {
            let d = *p - *first;
            if d.length_squared() > far.length_squared() { d } else { far }
        });
        let size2 = farthest.length_squared();
        if size2 <= ONE_PLACE * ONE_PLACE {
            return one;
        }
        let across = normal.cross(farthest);
        if others.iter().any(|p| across.dot(*p - *first).abs() > ON_LINE * size2) {
            Self::FaceFace
        } else {
            Self::EdgeFace
        }
    }

    /// The name in CSV files and pictures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::VertexFace => "vertex-face",
            Self::EdgeEdge => "edge-edge",
            Self::EdgeFace => "edge-face",
            Self::FaceFace => "face-face",
        }
    }
}

/// One basic contact that takes place, and where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactPoint {
    /// Index of the convex part of A in `World::moving`.
    pub part_a: u32,
    /// Index of the convex piece in `World::fixed`.
    pub piece_b: u32,
    /// The basic contact; its ids belong to those two polyhedra.
    pub contact: BasicContact,
    /// The application point App_k, metres, W.
    pub point_w: DVec3,
    /// Outward unit normal of its C-face, axes of W: the direction in which A is pushed.
    pub normal_w: DVec3,
    /// Signed distance of `x` to the C-face's plane, metres, `< 0` inside.
    pub distance: f64,
    /// The principal contact of the pair that it belongs to.
    pub kind: FormationKind,
}

/// The contacts of a tick. `Copy` and of fixed size: it travels in the tick record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFormation {
    /// The formation of the whole body.
    pub kind: FormationKind,
    count: u8,
    points: [ContactPoint; MAX_CONTACTS],
}

impl ContactFormation {
    /// No contact.
    pub const FREE: Self = Self {
        kind: FormationKind::Free,
        count: 0,
        points: [ContactPoint {
            part_a: 0,
            piece_b: 0,
            contact: BasicContact::TypeA { face_a: cspace::FaceId(0), vertex_b: cspace::VertexId(0) },
            point_w: DVec3::ZERO,
            normal_w: DVec3::ZERO,
            distance: 0.0,
            kind: FormationKind::Free,
        }; MAX_CONTACTS],
    };

    /// The contact points.
    #[must_use]
    pub fn points(&self) -> &[ContactPoint] {
        &self.points[..self.count as usize]
    }

    /// Adds a point; when full, replaces the shallowest if the new one is deeper. False if something was dropped.
    pub fn push(&mut self, point: ContactPoint) -> bool {
        if (self.count as usize) < MAX_CONTACTS {
            self.points[self.count as usize] = point;
            self.count += 1;
            return true;
        }
        let mut shallowest = 0;
        for (i, p) in self.points.iter().enumerate() {
            if p.distance > self.points[shallowest].distance {
                shallowest = i;
            }
        }
        if point.distance < self.points[shallowest].distance {
            self.points[shallowest] = point;
        }
        false
    }
}

impl Default for ContactFormation {
    fn default() -> Self {
        Self::FREE
    }
}
