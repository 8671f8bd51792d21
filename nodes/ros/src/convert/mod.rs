//! From our types to messages and back: everything that knows both.

mod diagnostics;
mod markers;
mod scene;
mod spatial;

pub use diagnostics::ServoReport;
pub use markers::MarkerPainter;
pub use scene::{scene_description, scene_from, sha256};
pub use spatial::*;
