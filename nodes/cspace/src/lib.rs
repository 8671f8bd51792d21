//! Contact tracking in configuration space between convex polyhedra
//! (Rosell and Vazquez 2004, sections II and III, and the appendix).
//!
//! `x` is the position of A's frame and `R` its rotation, both in W. `CO = B (+) (-R A)` is the C-obstacle: the set of
//! `x` at which A and B touch or overlap at this orientation. A C-face's plane is `f(x) = n.x - d` with `n` unit and
//! outward; `f < 0` is inside.

mod audit;
mod body;
mod body_tracker;
mod bvh;
mod c_face;
mod c_face_patch;
mod c_face_polygon;
mod calm;
mod certificate;
mod contact;
mod convex_cut;
mod crossing;
mod facet;
mod fold;
mod graph;
mod ids;
mod inner_polytope;
mod neighbors;
mod pair_state;
mod parallelogram;
mod placed;
mod polyhedron;
mod principal;
mod sides;
mod start;
mod stay;
mod support_table;
#[cfg(test)]
mod testing;
mod tracked;
mod tracker;
mod walk;
mod world;

pub(crate) use body::Body;
pub use body_tracker::{ActivePair, BodyTracker, MAX_NEAR_PIECES};
pub use c_face::{CFace, applicable_c_faces, contact_point, contact_point_turned, is_applicable, is_applicable_turned};
pub use c_face_polygon::{CFacePolygon, c_face_polygons};
pub use contact::BasicContact;
pub use convex_cut::{cut_out, polygon_area, split_polygon};
pub use graph::ContactGraph;
pub use ids::{EdgeId, FaceId, VertexId};
pub use polyhedron::{COPLANAR_TOLERANCE, DENT_TOLERANCE, Edge, Plane, Polyhedron, PolyhedronError};
pub use principal::{PARALLEL_ANGLE, PrincipalContact, principal_contact};
pub use tracked::Tracked;
pub use tracker::Tracker;
pub use world::{FixedPart, World};
