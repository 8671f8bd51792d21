//! Parameters of the nodes: declared with type, range and meaning; whatever does not fit is refused with the reason.
//!
//! The middleware binding has a parameter handler of its own, which knows neither ranges nor refusals nor arrays, and
//! forgets changes when more than ten come at once; so the services are served here.

mod declared;
mod patterns;
mod server;
mod template;
mod wire;

pub use declared::Declared;
pub use server::{Change, ParameterServer};
pub use template::yaml_template;
