use super::{Point, Vector3};
use serde::{Deserialize, Serialize};

/// `cspace_haptics_msgs/msg/BasicContact`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BasicContact {
    /// One of TYPE_*.
    #[serde(rename = "type")]
    pub kind: u8,
    /// Index of the face, vertex or edge of A, from 0, in the polyhedron as the scene has it after coplanar facets
    /// were merged.
    pub feature_a: u32,
    /// Index of the vertex, face or edge of B, from 0, likewise.
    pub feature_b: u32,
}

/// `cspace_haptics_msgs/msg/CFace`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CFace {
    /// Index of the convex part of A in the scene, from 0.
    pub part_a: u32,
    /// Index of the convex piece of the obstacles in the scene, from 0.
    pub piece_b: u32,
    /// The basic contact that takes place on it.
    pub contact: BasicContact,
    /// Outward unit normal, axes of the header's frame (W).
    pub normal: Vector3,
    /// Signed distance of A's origin to the plane, metres; < 0 inside the C-obstacle's half-space.
    pub distance: f64,
    /// Whether the tracker holds it as Near of its pair, the applicable C-face of largest signed distance.
    pub near: bool,
    /// Whether its basic contact takes place now, so that it is part of the contact formation.
    pub in_contact: bool,
    /// Outline of the face in C-space (positions of A's origin), metres, W, counter-clockwise seen from outside;
    /// empty if left out.
    pub outline: Vec<Point>,
}

/// `cspace_haptics_msgs/msg/ContactPoint`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactPoint {
    /// Index of the convex part of A in the scene, from 0.
    pub part_a: u32,
    /// Index of the convex piece of the obstacles in the scene, from 0.
    pub piece_b: u32,
    /// The basic contact; its features belong to those two polyhedra.
    pub contact: BasicContact,
    /// Application point of the contact force, metres, W.
    pub point: Point,
    /// Outward unit normal of its C-face, axes of W: the direction in which A is pushed.
    pub normal: Vector3,
    /// Signed distance of A's origin to the C-face's plane, metres; < 0 inside.
    pub distance: f64,
    /// Principal contact of the pair (part_a, piece_b) that it belongs to, one of PrincipalContact.KIND_*.
    pub kind: u8,
}

/// `cspace_haptics_msgs/msg/PrincipalContact`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PrincipalContact {
    /// Index of the convex part of A in the scene, from 0.
    pub part_a: u32,
    /// Index of the convex piece of the obstacles in the scene, from 0.
    pub piece_b: u32,
    /// One of KIND_*.
    pub kind: u8,
    /// The touching features, for example "face 2 - face 5" or "vertex 3 - face 0" (A's first).
    pub features: String,
}
