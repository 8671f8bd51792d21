use crate::chunk::Chunk;
use crate::mcap_record::{ChannelRecord, MAGIC, Parts, SchemaRecord, op};
use crate::resync;
use std::collections::VecDeque;
use std::fs::File;
use std::os::unix::fs::FileExt;

/// A stretch of a file that could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damage {
    /// File name.
    pub file: String,
    /// Where it begins, bytes from the file's start.
    pub offset: u64,
    /// Its length, bytes.
    pub length: u64,
    /// What is wrong with it.
    pub what: &'static str,
}

/// What a scan finds.
pub(crate) enum Found {
    Schema(SchemaRecord),
    Channel(ChannelRecord),
    Message { channel: u16, log_time: u64, data: Vec<u8> },
}

/// Reads an MCAP file from front to back without trusting it: index, footer and lengths are not relied upon, chunks must
/// fit their checksum, and after a damaged stretch it goes on at the next record that makes sense.
pub(crate) struct McapScan<'a> {
    name: &'a str,
    file: &'a File,
    at: u64,
    end: u64,
    open_chunks: bool,
    queue: VecDeque<Found>,
    damage: Vec<Damage>,
    complete: bool,
}

impl<'a> McapScan<'a> {
    /// A scan of `file`, called `name` in reports. Without `open_chunks` it skips what is in chunks.
    pub(crate) fn new(name: &'a str, file: &'a File, open_chunks: bool) -> Self {
        let end = file.metadata().map_or(0, |m| m.len());
        let mut scan =
            Self { name, file, at: 0, end, open_chunks, queue: VecDeque::new(), damage: Vec::new(), complete: false };
        if scan.peek::<8>(0) == Some(MAGIC) {
            scan.at = 8;
        } else if end == 0 {
            scan.report(0, 0, "the file is empty");
        } else {
            scan.skip_damage("this is not the beginning of an MCAP file");
        }
        scan
    }

    /// What could not be read so far.
    pub(crate) fn into_damage(self) -> Vec<Damage> {
        self.damage
    }

    /// Whether the file came to its proper end without damage.
    pub(crate) fn is_complete(&self) -> bool {
        self.complete && self.damage.is_empty()
    }

    fn peek<const N: usize>(&self, at: u64) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        (at.checked_add(N as u64)? <= self.end).then_some(())?;
        self.file.read_exact_at(&mut bytes, at).ok()?;
        Some(bytes)
    }

    /// Reads the `n` bytes at `at`, or as many as there are.
    fn read(&self, at: u64, n: u64) -> Vec<u8> {
        let n = n.min(self.end.saturating_sub(at)) as usize;
        let mut bytes = vec![0; n];
        match self.file.read_exact_at(&mut bytes, at) {
            Ok(()) => bytes,
            Err(_) => Vec::new(),
        }
    }

    fn report(&mut self, offset: u64, length: u64, what: &'static str) {
        self.damage.push(Damage { file: self.name.to_owned(), offset, length, what });
    }

    /// Goes on at the next record that makes sense.
    fn skip_damage(&mut self, what: &'static str) {
        let next = resync::next_record(self.file, self.at + 1, self.end);
        self.report(self.at, next - self.at, what);
        self.at = next;
    }

    /// Takes in the record at `at`; false at the end.
    fn step(&mut self) -> bool {
        if self.at >= self.end {
            if !self.complete && self.damage.last().is_none_or(|d| d.offset + d.length < self.end) {
                self.report(self.at, 0, "the file ends without footer: its writer was stopped within a write");
            }
            return false;
        }
        if self.end - self.at == 8 && self.peek::<8>(self.at) == Some(MAGIC) {
            self.complete = true;
            self.at = self.end;
            return false;
        }
        let Some(header) = self.peek::<9>(self.at) else {
            self.report(self.at, self.end - self.at, "the file is cut off within a record");
            self.at = self.end;
            return false;
        };
        let (kind, length) = resync::split_header(&header);
        let body = self.at + 9;
        let fits = body.checked_add(length).is_some_and(|e| e <= self.end);
        if kind == op::CHUNK {
            self.chunk(body, length, fits);
        } else if !fits || !resync::is_kind(kind) {
            // A message that is merely cut off ends the file; anything else may be a damaged length.
            self.skip_damage(if fits { "this is no record" } else { "the file is cut off or damaged within a record" });
        } else {
            if matches!(kind, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
                let bytes = self.read(body, length);
                match parse(kind, Parts(&bytes)) {
                    Some(found) => self.queue.push_back(found),
                    None => self.report(self.at, 9 + length, "a damaged record"),
                }
            }
            self.at = body + length;
        }
        true
    }

    fn chunk(&mut self, body: u64, length: u64, fits: bool) {
        let wanted = if self.open_chunks { length } else { length.min(64) };
        let bytes = self.read(body, wanted);
        let Some(chunk) = Chunk::parse(&bytes, length) else {
            return self.skip_damage("a damaged chunk header");
        };
        let from = self.at;
        self.at = body.saturating_add(length).min(self.end);
        if !fits {
            self.report(from, self.end - from, "the file is cut off within a chunk");
        }
        if !self.open_chunks {
            return;
        }
        debug_assert!(chunk.is_whole() == fits);
        match chunk.unpack() {
            Some(records) => self.open(&records),
            None => self.report(from, 9 + length, "a chunk does not fit its checksum"),
        }
    }

    /// Queues what is in a chunk, messages in the order of their times.
    fn open(&mut self, records: &[u8]) {
        let mut parts = Parts(records);
        let mut messages = Vec::new();
        while let Some((kind, body)) = parts.record() {
            match parse(kind, body) {
                Some(found @ Found::Message { .. }) => messages.push(found),
                Some(found) => self.queue.push_back(found),
                None => {}
            }
        }
        messages.sort_by_key(|m| if let Found::Message { log_time, .. } = m { *log_time } else { 0 });
        self.queue.extend(messages);
    }
}

impl Iterator for McapScan<'_> {
    type Item = Found;

    fn next(&mut self) -> Option<Found> {
        loop {
            if let Some(found) = self.queue.pop_front() {
                return Some(found);
            }
            if !self.step() {
                return None;
            }
        }
    }
}

fn parse(kind: u8, mut p: Parts<'_>) -> Option<Found> {
    match kind {
        op::SCHEMA => SchemaRecord::parse(p).map(Found::Schema),
        op::CHANNEL => ChannelRecord::parse(p).map(Found::Channel),
        op::MESSAGE => {
            let (channel, _sequence, log_time, _publish_time) = (p.u16()?, p.u32()?, p.u64()?, p.u64()?);
            Some(Found::Message { channel, log_time, data: p.0.to_vec() })
        }
        _ => None,
    }
}

/// Whether the summary of a finished file fits the checksum in its footer; writers may leave the checksum out.
pub(crate) fn summary_is_sound(file: &File) -> bool {
    const FOOTER: usize = 9 + 20;
    let sound = || {
        let end = file.metadata().ok()?.len();
        let from = end.checked_sub((FOOTER + MAGIC.len()) as u64)?;
        let mut footer = [0; FOOTER];
        file.read_exact_at(&mut footer, from).ok()?;
        let (kind, mut parts) = Parts(&footer).record()?;
        let (start, _, crc) = (parts.u64()?, parts.u64()?, parts.u32()?);
        if kind != op::FOOTER || start > from {
            return None;
        }
        if crc == 0 || start == 0 {
            return Some(true);
        }
        let mut bytes = vec![0; usize::try_from(end - start).ok()? - MAGIC.len() - 4];
        file.read_exact_at(&mut bytes, start).ok()?;
        Some(crc32fast::hash(&bytes) == crc)
    };
    sound().unwrap_or(false)
}
