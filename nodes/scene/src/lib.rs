//! Meshes and scene.yaml to convex parts; build time only.
