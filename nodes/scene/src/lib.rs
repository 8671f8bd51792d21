//! Meshes and scene.yaml to convex parts; build time only.
//!
//! A scene is read once into a [`Bundle`] of bytes and built from it without touching a file again, so what a bag
//! carries builds the very same parts.

mod bundle;
mod cut;
mod digits;
mod error;
mod flat;
mod hull;
mod mesh;
mod near_hull;
mod obj;
mod pieces;
mod scene;
mod scene_file;
mod stl;
mod urdf;

pub use bundle::Bundle;
pub use error::SceneError;
pub use flat::polyhedron;
pub use mesh::{Mesh, MeshError};
pub use obj::{ObjLines, parse_obj, parse_obj_with_lines};
pub use scene::{Body, Scene};
pub use stl::parse_stl;
