//! One tick as a pure function, TickRecord, the loop, configuration.

mod aligned_device;
mod commands;
pub mod config;
mod gain_ramp;
mod health;
mod loop_status;
mod mapping;
mod motion;
mod operator_scene;
mod output;
mod record;
mod sample_check;
mod sample_count;
mod servo_handle;
mod servo_loop;
mod stability;
mod stretching;
mod tick;

pub use aligned_device::AlignedDevice;
pub use commands::Commands;
pub use config::Config;
pub use health::Health;
pub use loop_status::LoopStatus;
pub use operator_scene::operator_plan;
pub use record::{TickInput, TickRecord};
pub use servo_handle::{LoopConfig, LoopError, Servo, ServoHandle, spawn};
pub use stability::{MotionKind, RenderedMotion, StabilityFinding, check_stability, stability_findings};
pub use tick::{Tick, renderer};
