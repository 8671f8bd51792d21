//! Meshes and scene.yaml to convex parts; build time only.

mod cut;
mod hull;
mod mesh;
mod obj;
mod stl;

pub use mesh::{Mesh, MeshError};
pub use obj::parse_obj;
pub use stl::parse_stl;
