//! Records topics as they come, in their own bytes, into a bag.

mod options;
mod session;
mod tick_count;

pub use options::{RecorderOptions, absolute_name};
pub use session::{Recorder, Summary};
