use crate::mcap_record::{ChannelRecord, MAGIC, Put, SchemaRecord, op};
use crate::{BagError, Compression};
use std::fs::{File, OpenOptions};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

/// An MCAP file under construction that is a complete MCAP file after every flush.
///
/// A flush closes the chunk and writes it together with a new summary and footer, in one piece, over the old summary and
/// footer. So a reader that knows nothing of this finds a finished file whenever the writer was killed between two
/// flushes; if it was killed within the write itself, [`crate::BagReader`] finds all chunks but the last.
/// (The writer of the crate `mcap` closes chunks on demand too, but leaves a file without footer, which most readers refuse.)
#[derive(Debug)]
pub(crate) struct McapFile {
    path: PathBuf,
    file: File,
    compression: Compression,
    schemas: Vec<SchemaRecord>,
    channels: Vec<ChannelRecord>,
    /// Records of the open chunk, not compressed yet.
    pending: Vec<u8>,
    /// Per channel of the open chunk: log time and offset of each message.
    pending_index: Vec<Vec<(u64, u64)>>,
    pending_times: Option<(u64, u64)>,
    /// Chunk index records so far.
    chunk_indexes: Vec<u8>,
    chunks: u32,
    counts: Vec<u64>,
    times: Option<(u64, u64)>,
    /// Where the data section ends and the summary begins.
    data_end: u64,
    /// Bytes for the next write; kept so that memory stays flat.
    scratch: Vec<u8>,
}

impl McapFile {
    /// A new file with nothing in it yet; it is complete already.
    pub(crate) fn create(path: &Path, compression: Compression) -> Result<Self, BagError> {
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(path)
            .map_err(|e| BagError::io("cannot create the bag's file", path, e))?;
        let mut mcap = Self {
            path: path.to_path_buf(),
            file,
            compression,
            schemas: Vec::new(),
            channels: Vec::new(),
            pending: Vec::new(),
            pending_index: Vec::new(),
            pending_times: None,
            chunk_indexes: Vec::new(),
            chunks: 0,
            counts: Vec::new(),
            times: None,
            data_end: 0,
            scratch: Vec::new(),
        };
        let mut out = MAGIC.to_vec();
        out.record(op::HEADER, |r| {
            r.text("ros2").text(concat!("cspace_haptics ", env!("CARGO_PKG_VERSION")));
        });
        let data_end = out.len() as u64;
        mcap.put_summary(&mut out, data_end);
        mcap.write_at(&out, 0)?;
        mcap.data_end = data_end;
        Ok(mcap)
    }

    /// Path of the file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes of data in the file and in the open chunk.
    pub(crate) fn size(&self) -> u64 {
        self.data_end + self.pending.len() as u64
    }

    /// Bytes in the open chunk.
    pub(crate) fn pending_size(&self) -> usize {
        self.pending.len()
    }

    /// Log times of the first and the last message, ns; the open chunk counts.
    pub(crate) fn times(&self) -> Option<(u64, u64)> {
        merged(self.times, self.pending_times)
    }

    /// Messages in the file; the open chunk counts.
    pub(crate) fn count(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Adds a topic; its number is the position in the order of adding.
    pub(crate) fn add_channel(&mut self, topic: &str, schema: SchemaRecord, metadata: Vec<(String, String)>) {
        let known = self.schemas.iter().find(|s| s.name == schema.name && s.text == schema.text).map(|s| s.id);
        let schema_id = known.unwrap_or_else(|| {
            // Schema 0 means "none" in MCAP.
            let id = self.schemas.len() as u16 + 1;
            let schema = SchemaRecord { id, ..schema };
            schema.put(&mut self.pending);
            self.schemas.push(schema);
            id
        });
        let channel = ChannelRecord {
            id: self.channels.len() as u16 + 1,
            schema: schema_id,
            topic: topic.to_owned(),
            encoding: "cdr".to_owned(),
            metadata,
        };
        channel.put(&mut self.pending);
        self.channels.push(channel);
        self.pending_index.push(Vec::new());
        self.counts.push(0);
    }

    /// Puts a message of topic number `channel` into the open chunk. Times in ns.
    pub(crate) fn push(&mut self, channel: usize, sequence: u32, log_time: u64, publish_time: u64, data: &[u8]) {
        self.pending_index[channel].push((log_time, self.pending.len() as u64));
        self.counts[channel] += 1;
        self.pending_times = merged(self.pending_times, Some((log_time, log_time)));
        let id = self.channels[channel].id;
        self.pending.record(op::MESSAGE, |r| {
            r.u16(id).u32(sequence).u64(log_time).u64(publish_time).extend_from_slice(data);
        });
    }

    /// Closes the chunk and writes it; afterwards the file is complete. Nothing is lost on an error: the same chunk is
    /// tried again at the next flush, and what stands in the file stays complete if the disk was full.
    pub(crate) fn flush(&mut self) -> Result<(), BagError> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let mut out = std::mem::take(&mut self.scratch);
        out.clear();
        let undo = self.chunk_indexes.len();
        let done = self.put_chunk(&mut out).and_then(|()| {
            let data_end = self.data_end + out.len() as u64;
            let times = self.times;
            self.times = self.times();
            self.chunks += 1;
            self.put_summary(&mut out, data_end);
            self.write_at(&out, self.data_end).map(|()| data_end).inspect_err(|_| {
                self.times = times;
                self.chunks -= 1;
            })
        });
        self.scratch = out;
        match done {
            Ok(data_end) => {
                self.data_end = data_end;
                self.pending.clear();
                self.pending_index.iter_mut().for_each(Vec::clear);
                self.pending_times = None;
                Ok(())
            }
            Err(e) => {
                self.chunk_indexes.truncate(undo);
                Err(e)
            }
        }
    }

    /// Flushes and waits until the data has reached the disk.
    pub(crate) fn finish(&mut self) -> Result<(), BagError> {
        self.flush()?;
        self.file.sync_data().map_err(|e| BagError::io("cannot write the bag", &self.path, e))
    }

    fn put_chunk(&mut self, out: &mut Vec<u8>) -> Result<(), BagError> {
        let (start, end) = self.pending_times.unwrap_or((0, 0));
        let size = self.pending.len() as u64;
        let compressed = match self.compression {
            Compression::None => None,
            Compression::Zstd(level) => Some(
                zstd::bulk::compress(&self.pending, level)
                    .map_err(|e| BagError::io("cannot compress a chunk", &self.path, e))?,
            ),
        };
        let name = if compressed.is_some() { "zstd" } else { "" };
        let data = compressed.as_ref().unwrap_or(&self.pending);
        let crc = crc32fast::hash(&self.pending);
        out.record(op::CHUNK, |r| {
            r.u64(start).u64(end).u64(size).u32(crc).text(name).u64(data.len() as u64).extend_from_slice(data);
        });
        let chunk_length = out.len() as u64;
        let mut offsets: Vec<u8> = Vec::new();
        for (channel, entries) in self.channels.iter().zip(&self.pending_index) {
            if entries.is_empty() {
                continue;
            }
            offsets.u16(channel.id).u64(self.data_end + out.len() as u64);
            out.record(op::MESSAGE_INDEX, |r| {
                r.u16(channel.id).u32(entries.len() as u32 * 16);
                for &(time, offset) in entries {
                    r.u64(time).u64(offset);
                }
            });
        }
        let (at, index_length, data_length) = (self.data_end, out.len() as u64 - chunk_length, data.len() as u64);
        self.chunk_indexes.record(op::CHUNK_INDEX, |r| {
            r.u64(start).u64(end).u64(at).u64(chunk_length);
            r.u32(offsets.len() as u32).extend_from_slice(&offsets);
            r.u64(index_length).text(name).u64(data_length).u64(size);
        });
        Ok(())
    }

    /// Data end, summary, footer and magic for a data section that ends at `data_end`.
    fn put_summary(&self, out: &mut Vec<u8>, data_end: u64) {
        let base = out.len();
        let at = |out: &Vec<u8>| data_end + (out.len() - base) as u64;
        out.record(op::DATA_END, |r| {
            r.u32(0);
        });
        let summary_from = out.len();
        let summary_start = at(out);
        let mut groups = Vec::new();
        for schema in &self.schemas {
            schema.put(out);
        }
        groups.push((op::SCHEMA, summary_start, at(out)));
        for channel in &self.channels {
            channel.put(out);
        }
        groups.push((op::CHANNEL, groups[0].2, at(out)));
        out.extend_from_slice(&self.chunk_indexes);
        groups.push((op::CHUNK_INDEX, groups[1].2, at(out)));
        let (first, last) = self.times.unwrap_or((0, 0));
        out.record(op::STATISTICS, |r| {
            r.u64(self.counts.iter().sum()).u16(self.schemas.len() as u16).u32(self.channels.len() as u32);
            r.u32(0).u32(0).u32(self.chunks).u64(first).u64(last);
            r.u32(self.channels.len() as u32 * 10);
            for (channel, count) in self.channels.iter().zip(&self.counts) {
                r.u16(channel.id).u64(*count);
            }
        });
        groups.push((op::STATISTICS, groups[2].2, at(out)));
        let offsets_start = at(out);
        for (kind, from, to) in groups.into_iter().filter(|(_, from, to)| from != to) {
            out.record(op::SUMMARY_OFFSET, |r| {
                r.push(kind);
                r.u64(from).u64(to - from);
            });
        }
        // The checksum covers the summary and the footer up to itself.
        let footer_from = out.len();
        out.record(op::FOOTER, |r| {
            r.u64(summary_start).u64(offsets_start).u32(0);
        });
        let crc = crc32fast::hash(&out[summary_from..footer_from + 9 + 16]);
        let end = out.len();
        out[end - 4..].copy_from_slice(&crc.to_le_bytes());
        out.extend_from_slice(&MAGIC);
    }

    fn write_at(&self, bytes: &[u8], offset: u64) -> Result<(), BagError> {
        let fail = |e| BagError::io("cannot write the bag", &self.path, e);
        // Reserve first: a full disk must show before the old summary is overwritten.
        let reserve =
            rustix::fs::fallocate(&self.file, rustix::fs::FallocateFlags::KEEP_SIZE, offset, bytes.len().max(1) as u64);
        match reserve {
            // Not every file system can reserve; then the write itself tells.
            Ok(()) | Err(rustix::io::Errno::OPNOTSUPP | rustix::io::Errno::NOSYS) => {}
            Err(e) => return Err(fail(e.into())),
        }
        self.file.write_all_at(bytes, offset).map_err(fail)
    }
}

fn merged(a: Option<(u64, u64)>, b: Option<(u64, u64)>) -> Option<(u64, u64)> {
    match (a, b) {
        (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
        (a, b) => a.or(b),
    }
}
