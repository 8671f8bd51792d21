//! Contacts of features that lie flush with larger ones.

use crate::FeatureBook;
use crate::feature_book::Side;
use crate::principal_contact::{Feature, PrincipalContact};
use haptics::FormationKind;
use spatial::{DQuat, DVec3};

/// Features whose directions differ less lie flush, rad.
const FLUSH: f64 = 1e-3;
/// Cosine between the contact's normal and that of a face that it may be a contact of.
const AHEAD: f64 = 0.9;

impl FeatureBook {
    /// `contact`, or the contact of the larger features around it that lie flush in one of `rotations` (A's in W).
    /// `normal_w` is the contact's normal, outward from B.
    ///
    /// At the rim of a face, or where another piece takes over, only some of the basic contacts of two faces are left. And
    /// a part that is pressed beside its middle tips in the proxy by as much as the coupling gives: what the hand holds
    /// flush counts as flush.
    pub(crate) fn with_flush_features(
        &self,
        contact: PrincipalContact,
        rotations: [DQuat; 2],
        normal_w: DVec3,
    ) -> PrincipalContact {
        let Some(normal_w) = normal_w.try_normalize() else { return contact };
        let at = |rotation| Flush { book: self, contact, rotation, normal_w };
        let faces = || rotations.into_iter().find_map(|r| at(r).faces());
        let edge_and_face = || rotations.into_iter().find_map(|r| at(r).edge_and_face());
        match contact.kind {
            FormationKind::Free | FormationKind::FaceFace => contact,
            FormationKind::EdgeFace => faces().unwrap_or(contact),
            FormationKind::VertexFace | FormationKind::EdgeEdge => faces().or_else(edge_and_face).unwrap_or(contact),
        }
    }
}

/// A contact and the larger features around it, for one orientation of A.
struct Flush<'a> {
    book: &'a FeatureBook,
    contact: PrincipalContact,
    rotation: DQuat,
    normal_w: DVec3,
}

impl Flush<'_> {
    /// The contact of two faces in one plane.
    fn faces(&self) -> Option<PrincipalContact> {
        let pairs = self.faces_a().flat_map(|a| self.faces_b().map(move |b| (a, b)));
        let (a, b) = pairs.into_iter().find(|((_, a), (_, b))| -a.dot(*b) >= 1.0 - 0.5 * FLUSH * FLUSH)?;
        Some(PrincipalContact { feature_a: a.0, feature_b: b.0, kind: FormationKind::FaceFace, ..self.contact })
    }

    /// The contact of an edge that lies on a face.
    fn edge_and_face(&self) -> Option<PrincipalContact> {
        let PrincipalContact { part_a, feature_a, piece_b, feature_b, .. } = self.contact;
        let (a, b) = (&self.book.a, &self.book.b);
        let lies = |edge: DVec3, (_, normal): &(Feature, DVec3)| edge.dot(*normal).abs() <= FLUSH;
        let edge_of_a = a.edges_at(part_a, feature_a).into_iter().find_map(|(edge, along)| {
            let face = self.faces_b().find(|f| lies(self.rotation * along, f))?;
            Some((edge, face.0))
        });
        let edge_of_b = || {
            b.edges_at(piece_b, feature_b).into_iter().find_map(|(edge, along)| {
                let face = self.faces_a().find(|f| lies(along, f))?;
                Some((face.0, edge))
            })
        };
        let (feature_a, feature_b) = edge_of_a.or_else(edge_of_b)?;
        Some(PrincipalContact { feature_a, feature_b, kind: FormationKind::EdgeFace, ..self.contact })
    }

    /// The faces around A's feature that look against the normal, with their normals in W.
    fn faces_a(&self) -> impl Iterator<Item = (Feature, DVec3)> {
        let PrincipalContact { part_a, feature_a, .. } = self.contact;
        faces(&self.book.a, part_a, feature_a, self.rotation, -self.normal_w)
    }

    /// The faces around B's feature that look along the normal, with their normals in W.
    fn faces_b(&self) -> impl Iterator<Item = (Feature, DVec3)> {
        let PrincipalContact { piece_b, feature_b, .. } = self.contact;
        faces(&self.book.b, piece_b, feature_b, DQuat::IDENTITY, self.normal_w)
    }
}

fn faces(
    side: &Side,
    piece: u32,
    feature: Feature,
    rotation: DQuat,
    outward_w: DVec3,
) -> impl Iterator<Item = (Feature, DVec3)> {
    let all = side.faces_at(piece, feature).into_iter();
    all.map(move |(face, normal)| (face, rotation * normal)).filter(move |(_, normal)| normal.dot(outward_w) >= AHEAD)
}
