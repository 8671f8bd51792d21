//! One tick as a pure function, TickRecord, the loop, configuration.

mod health;
mod record;

pub use health::Health;
pub use record::{TickInput, TickRecord};
