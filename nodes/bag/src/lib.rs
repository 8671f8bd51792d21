//! rosbag2 (MCAP) directories, written and read without ROS.

mod bag_reader;
mod bag_writer;
mod catalog;
pub mod cdr;
mod chunk;
mod convert;
mod definition;
mod error;
mod info;
mod mcap_file;
mod mcap_record;
mod mcap_scan;
mod metadata;
pub mod msg;
mod poses;
mod qos;
mod resync;
mod summary;
mod ticks;
mod type_hash;

pub use bag_reader::{BagMessage, BagReader, Messages, Topic};
pub use bag_writer::{BagOptions, BagWriter, Compression, TopicId};
pub use catalog::{Catalog, TypeDescription};
pub use convert::{basic_contact_to_msg, contact_to_msg, gains_to_msg, tick_from_msg, tick_to_msg};
pub use definition::{Count, Field, parse_fields};
pub use error::BagError;
pub use info::{BagInfo, TickCount};
pub use mcap_scan::Damage;
pub use metadata::{FileMetadata, TopicMetadata};
pub use poses::{PoseLog, read_poses};
pub use qos::Qos;
pub use summary::RunSummary;
pub use ticks::{TickLog, TickWriter, Ticks, read_ticks, write_ticks};
