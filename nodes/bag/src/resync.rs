//! Finding the next sound record behind a damaged stretch of an MCAP file.

use crate::chunk::Chunk;
use crate::mcap_record::op;
use std::fs::File;
use std::os::unix::fs::FileExt;

/// Bytes looked at in one go.
const WINDOW: usize = 1 << 20;

/// Kind and length of a record from its first nine bytes.
pub(crate) fn split_header(header: &[u8; 9]) -> (u8, u64) {
    let [kind, length @ ..] = *header;
    (kind, u64::from_le_bytes(length))
}

/// Whether MCAP knows this kind of record, or leaves it to private use.
pub(crate) fn is_kind(kind: u8) -> bool {
    (op::HEADER..=op::DATA_END).contains(&kind) || kind >= 0x80
}

/// The first offset from `from` on where a sound record begins, or `end`.
pub(crate) fn next_record(file: &File, from: u64, end: u64) -> u64 {
    let mut at = from;
    let mut window = vec![0; WINDOW];
    while at + 9 <= end {
        let n = ((end - at) as usize).min(WINDOW);
        if file.read_exact_at(&mut window[..n], at).is_err() {
            return end;
        }
        for (i, header) in window[..n].windows(9).enumerate() {
            // Cheap test first: a kind, and a length below 4 GiB.
            if is_start(header[0]) && header[5..] == [0; 4] && is_sound(file, at + i as u64, end) {
                return at + i as u64;
            }
        }
        at += (n - 8) as u64;
    }
    end
}

/// Kinds of records at which reading can go on.
fn is_start(kind: u8) -> bool {
    matches!(kind, op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK | op::MESSAGE_INDEX | op::DATA_END | op::FOOTER)
}

fn is_sound(file: &File, at: u64, end: u64) -> bool {
    let Some((kind, length)) = header(file, at, end) else { return false };
    if kind == op::CHUNK {
        let mut bytes = [0; 64];
        let n = bytes.len().min((end - at - 9) as usize);
        return file.read_exact_at(&mut bytes[..n], at + 9).is_ok() && Chunk::parse(&bytes[..n], length).is_some();
    }
    let least = match kind {
        op::MESSAGE => 22,
        op::CHANNEL => 16,
        op::SCHEMA => 14,
        op::FOOTER => 20,
        op::MESSAGE_INDEX => 6,
        _ => 4,
    };
    // One header may look right by chance; two more behind it hardly can. The file's end counts as one.
    let mut next = at + 9 + length;
    (least..1 << 31).contains(&length)
        && (0..2).all(|_| {
            if next + 8 >= end {
                return next <= end;
            }
            match header(file, next, end) {
                Some((_, n)) => {
                    next += 9 + n;
                    true
                }
                None => false,
            }
        })
}

/// Kind and length of the record at `at`, if it is a known kind and ends within the file.
fn header(file: &File, at: u64, end: u64) -> Option<(u8, u64)> {
    let mut bytes = [0; 9];
    (at + 9 <= end).then_some(())?;
    file.read_exact_at(&mut bytes, at).ok()?;
    let (kind, length) = split_header(&bytes);
    let fits = (at + 9).checked_add(length)? <= end;
    (is_kind(kind) && (fits || kind == op::CHUNK)).then_some((kind, length))
}
