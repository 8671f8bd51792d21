//! Records topics as they come, in their own bytes, into a bag.

mod options;
mod session;
mod tick_count;

pub use options::RecorderOptions;
pub use session::{Recorder, Summary};
