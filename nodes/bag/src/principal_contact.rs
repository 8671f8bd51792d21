use crate::FeatureBook;
use cspace::{BasicContact, EdgeId, FaceId, VertexId};
use haptics::{ContactFormation, ContactPoint, FormationKind};
use spatial::{DQuat, DVec3};
use std::fmt;

/// A feature of a polyhedron that touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(EdgeId),
    /// A face.
    Face(FaceId),
    /// An edge or face that the basic contacts alone do not tell; known once the scene's geometry is at hand.
    Unknown,
}

impl fmt::Display for Feature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => write!(f, "vertex{}", v.0),
            Self::Edge(e) => write!(f, "edge{}", e.0),
            Self::Face(s) => write!(f, "face{}", s.0),
            Self::Unknown => f.write_str("unknown"),
        }
    }
}

/// A principal contact: two features that touch and are not both part of the boundary of features that touch
/// (Xiao and Zhang 1997). A set of them names a contact state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrincipalContact {
    /// Convex part of A.
    pub part_a: u32,
    /// Its feature.
    pub feature_a: Feature,
    /// Convex piece of the obstacles. Of faces that lie in one plane of an obstacle, the first stands for all.
    pub piece_b: u32,
    /// Its feature.
    pub feature_b: Feature,
    /// Which kinds of features.
    pub kind: FormationKind,
}

impl PrincipalContact {
    /// The features, A's first, as messages have them: `face2 - face5`.
    #[must_use]
    pub fn features(&self) -> String {
        format!("{} - {}", self.feature_a, self.feature_b)
    }
}

impl fmt::Display for PrincipalContact {
    /// `A0.face2-B3.face5`: part, feature, piece, feature.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "A{}.{}-B{}.{}", self.part_a, self.feature_a, self.piece_b, self.feature_b)
    }
}

/// The principal contacts of a formation in a fixed order. `rotations` are A's in W, at the contacts and as the hand holds
/// it; with the geometry in `book` faces that lie in one plane become one, and what is part of a larger contact is left out.
pub(crate) fn principal_contacts(
    formation: &ContactFormation,
    rotations: [DQuat; 2],
    book: Option<&FeatureBook>,
) -> Vec<PrincipalContact> {
    let points = formation.points();
    let mut found: Vec<PrincipalContact> = Vec::new();
    for (i, first) in points.iter().enumerate() {
        let is_same_pair = |p: &&ContactPoint| p.part_a == first.part_a && p.piece_b == first.piece_b;
        if points[..i].iter().any(|p| is_same_pair(&p)) {
            continue;
        }
        let group: Vec<&ContactPoint> = points.iter().filter(is_same_pair).collect();
        let mut contact = of_pair(&group, rotations, book);
        if let Some(book) = book {
            (contact.part_a, contact.feature_a) = book.a.representative(contact.part_a, contact.feature_a);
            (contact.piece_b, contact.feature_b) = book.b.representative(contact.piece_b, contact.feature_b);
        }
        if !found.contains(&contact) {
            found.push(contact);
        }
    }
    if let Some(book) = book {
        let all = found.clone();
        found.retain(|c| !all.iter().any(|other| other != c && book.is_part_of(c, other)));
    }
    found.sort();
    found
}

/// The principal contact of one pair, from its basic contacts.
fn of_pair(group: &[&ContactPoint], rotations: [DQuat; 2], book: Option<&FeatureBook>) -> PrincipalContact {
    let part_a = group[0].part_a;
    let piece_b = group[0].piece_b;
    let kind = group.iter().map(|p| p.kind).max().unwrap_or_default();
    let ids = Ids::of(group);
    let normal_w = group.iter().map(|p| p.normal_w).sum::<DVec3>();
    let normal_a = rotations[0].conjugate() * -normal_w;
    let (mut feature_a, mut feature_b) = match kind {
        FormationKind::FaceFace => (ids.face_a(), ids.face_b()),
        FormationKind::EdgeFace if ids.is_face_on_b() => (ids.edge_a(), ids.face_b()),
        FormationKind::EdgeFace => (ids.face_a(), ids.edge_b()),
        FormationKind::Free | FormationKind::VertexFace | FormationKind::EdgeEdge => single(&group[0].contact),
    };
    if let Some(book) = book {
        let face_on_b = ids.is_face_on_b();
        if feature_a == Feature::Unknown {
            let wants_face = kind == FormationKind::FaceFace || !face_on_b;
            feature_a = book.a.complete(part_a, wants_face, &ids.vertices_a, normal_a);
        }
        if feature_b == Feature::Unknown {
            let wants_face = kind == FormationKind::FaceFace || face_on_b;
            feature_b = book.b.complete(piece_b, wants_face, &ids.vertices_b, normal_w);
        }
    }
    let contact = PrincipalContact { part_a, feature_a, piece_b, feature_b, kind };
    match book {
        Some(book) => book.with_flush_features(contact, rotations, normal_w),
        None => contact,
    }
}

fn single(contact: &BasicContact) -> (Feature, Feature) {
    match *contact {
        BasicContact::TypeA { face_a, vertex_b } => (Feature::Face(face_a), Feature::Vertex(vertex_b)),
        BasicContact::TypeB { vertex_a, face_b } => (Feature::Vertex(vertex_a), Feature::Face(face_b)),
        BasicContact::TypeC { edge_a, edge_b } => (Feature::Edge(edge_a), Feature::Edge(edge_b)),
    }
}

/// The features that the basic contacts of one pair name.
#[derive(Default)]
struct Ids {
    faces_a: Vec<FaceId>,
    edges_a: Vec<EdgeId>,
    vertices_a: Vec<VertexId>,
    faces_b: Vec<FaceId>,
    edges_b: Vec<EdgeId>,
    vertices_b: Vec<VertexId>,
}

impl Ids {
    fn of(group: &[&ContactPoint]) -> Self {
        let mut ids = Self::default();
        for point in group {
            match point.contact {
                BasicContact::TypeA { face_a, vertex_b } => {
                    ids.faces_a.push(face_a);
                    ids.vertices_b.push(vertex_b);
                }
                BasicContact::TypeB { vertex_a, face_b } => {
                    ids.vertices_a.push(vertex_a);
                    ids.faces_b.push(face_b);
                }
                BasicContact::TypeC { edge_a, edge_b } => {
                    ids.edges_a.push(edge_a);
                    ids.edges_b.push(edge_b);
                }
            }
        }
        ids
    }

    /// Of an edge on a face: whether the face is B's. Vertices of A lie on faces of B; where only edges cross, the edge
    /// that crosses several is the one on the face.
    fn is_face_on_b(&self) -> bool {
        if self.faces_a.is_empty() && self.faces_b.is_empty() {
            self.edges_a.windows(2).all(|w| w[0] == w[1])
        } else {
            !self.faces_b.is_empty()
        }
    }

    fn face_a(&self) -> Feature {
        self.faces_a.first().map_or(Feature::Unknown, |&f| Feature::Face(f))
    }

    fn face_b(&self) -> Feature {
        self.faces_b.first().map_or(Feature::Unknown, |&f| Feature::Face(f))
    }

    fn edge_a(&self) -> Feature {
        self.edges_a.first().map_or(Feature::Unknown, |&e| Feature::Edge(e))
    }

    fn edge_b(&self) -> Feature {
        self.edges_b.first().map_or(Feature::Unknown, |&e| Feature::Edge(e))
    }
}
