//! Physical space and C-space side by side in rerun: [`Recorder`] turns a [`Subject`] (the bodies) and
//! [`servo::TickRecord`]s into a recording with its layout, to a file or a running viewer; [`Feed`] does so on a thread of
//! its own and never blocks who feeds it; [`record_overview`] shows a scene without a run.
//!
//! The only crate that knows rerun. rerun has a `glam` of its own: arrays cross the border, as `f32`.

mod applicability;
mod blueprint;
mod budget;
mod clock;
mod contact_states;
mod cspace_view;
mod error;
mod events;
mod eye;
mod feed;
mod layout;
mod legend;
mod overview;
mod pairs;
mod palette;
mod physical;
mod recorder;
mod series;
mod sink;
mod slice;
mod subject;
mod surface;
mod union;

pub use error::InspectError;
pub use eye::{Eye, Eyes};
pub use feed::Feed;
pub use overview::record_overview;
pub use recorder::{Options, Recorder};
pub use sink::Sink;
pub use subject::Subject;
