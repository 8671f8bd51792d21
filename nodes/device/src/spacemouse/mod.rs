//! 3Dconnexion SpaceMouse: six axes and buttons over HID. Input only: force is displayed, not felt.

mod config;
mod device;
mod driver;
mod hid;
mod link;
mod motion;
mod report;

pub use config::{SpaceMouseConfig, SpaceMouseError, SpaceMouseMode};
pub use device::{SpaceMouse, SpaceMouseMonitor};
pub use driver::DriverNotes;
pub use link::{HidBus, HidLink, LinkLost};
pub use report::{Garbage, Report};
