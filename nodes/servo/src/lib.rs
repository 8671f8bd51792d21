//! One tick as a pure function, TickRecord, the loop, configuration.

mod commands;
pub mod config;
mod aligned_device;
mod gain_ramp;
mod mapping;
mod motion;
mod output;
mod sample_check;
mod tick;
mod health;
mod loop_status;
mod operator_scene;
mod record;
mod servo_handle;
mod servo_loop;

pub use aligned_device::AlignedDevice;
pub use commands::Commands;
pub use config::Config;
pub use health::Health;
pub use loop_status::LoopStatus;
pub use operator_scene::operator_plan;
pub use record::{TickInput, TickRecord};
pub use servo_handle::{LoopConfig, LoopError, Servo, ServoHandle, spawn};
pub use tick::{Tick, renderer};
