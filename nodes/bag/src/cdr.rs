//! Plain CDR (XCDR version 1) with the four-byte header that ROS 2 puts in front.

use crate::BagError;
use crate::msg::Message;
use byteorder::{BigEndian, LittleEndian};

/// Representation identifier of plain CDR, little-endian, and no options.
const LITTLE_ENDIAN_HEADER: [u8; 4] = [0, 1, 0, 0];

/// The message as bytes, as DDS carries and bags hold it.
///
/// # Errors
/// If the message cannot be encoded (a sequence longer than 2^32).
pub fn encode<M: Message>(message: &M) -> Result<Vec<u8>, BagError> {
    let mut out = LITTLE_ENDIAN_HEADER.to_vec();
    let body =
        cdr_encoding::to_vec::<M, LittleEndian>(message).map_err(|e| BagError::message(M::NAME, e.to_string()))?;
    out.extend_from_slice(&body);
    Ok(out)
}

/// The message that `encode` or any ROS 2 node turned into `bytes`, of either byte order.
///
/// # Errors
/// If the bytes are too short, in another representation, or hold text that is not UTF-8.
pub fn decode<M: Message>(bytes: &[u8]) -> Result<M, BagError> {
    let fail = |reason: String| BagError::message(M::NAME, reason);
    let Some((header, body)) = bytes.split_at_checked(4) else {
        return Err(fail(format!("{} bytes are no message", bytes.len())));
    };
    let read = match header[..2] {
        [0, 0] => cdr_encoding::from_bytes::<M, BigEndian>(body),
        [0, 1] => cdr_encoding::from_bytes::<M, LittleEndian>(body),
        _ => return Err(fail(format!("representation {:02x}{:02x} is not plain CDR", header[0], header[1]))),
    };
    read.map(|(message, _)| message).map_err(|e| fail(e.to_string()))
}
