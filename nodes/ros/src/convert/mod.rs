//! From our types to messages and back: everything that knows both.

mod markers;
mod spatial;

pub use markers::MarkerPainter;
pub use spatial::*;
