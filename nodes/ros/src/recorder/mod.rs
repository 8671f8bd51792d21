//! Records topics as they come, in their own bytes, into a bag.

mod log_clock;
mod options;
mod session;
mod tick_count;

pub use log_clock::LogClock;
pub use options::{RecorderOptions, absolute_name};
pub use session::{Recorder, Summary};
