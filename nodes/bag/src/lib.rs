//! rosbag2 (MCAP) directories, written and read without ROS.

mod bag_writer;
mod catalog;
pub mod cdr;
mod convert;
mod definition;
mod error;
mod mcap_file;
mod mcap_record;
mod metadata;
pub mod msg;
mod qos;
mod type_hash;

pub use bag_writer::{BagOptions, BagWriter, Compression, TopicId};
pub use catalog::{Catalog, TypeDescription};
pub use convert::{basic_contact_to_msg, contact_to_msg, gains_to_msg, tick_from_msg, tick_to_msg};
pub use definition::{Count, Field, parse_fields};
pub use error::BagError;
pub use metadata::{FileMetadata, TopicMetadata};
pub use qos::Qos;
