use crate::mcap_record::Parts;
use std::io::Read;

/// No chunk that anyone writes unpacks to more; a damaged size must not fill the memory.
const MOST_BYTES: u64 = 1 << 30;

/// A chunk record taken apart, its data still packed.
pub(crate) struct Chunk<'a> {
    unpacked_size: u64,
    crc: u32,
    compression: &'a str,
    data: &'a [u8],
    whole: bool,
}

/// The bytes of a chunk record before its data, given its compression's name.
const FIXED_HEADER: usize = 8 + 8 + 8 + 4 + 4 + 8;

impl<'a> Chunk<'a> {
    /// Takes the body of a chunk record apart. `length` is what the record says, `body` may be cut short by the end of
    /// the file. `None` if the numbers in it contradict each other.
    pub(crate) fn parse(body: &'a [u8], length: u64) -> Option<Self> {
        let mut p = Parts(body);
        let (start, end) = (p.u64()?, p.u64()?);
        let (unpacked_size, crc, compression, packed_size) = (p.u64()?, p.u32()?, p.text()?, p.u64()?);
        let header = (FIXED_HEADER + compression.len()) as u64;
        let sound = start <= end
            && packed_size.checked_add(header) == Some(length)
            && unpacked_size <= MOST_BYTES
            && matches!(compression, "" | "zstd" | "lz4");
        sound.then_some(Self { unpacked_size, crc, compression, data: p.0, whole: p.0.len() as u64 == packed_size })
    }

    /// The records in it. Of a chunk that is cut short, what can be unpacked; of a whole one, all or, if its checksum
    /// does not fit, nothing.
    pub(crate) fn unpack(&self) -> Option<Vec<u8>> {
        let mut out = Vec::new();
        let limit = self.unpacked_size + 1;
        let read = match self.compression {
            "" => self.data.take(limit).read_to_end(&mut out),
            "zstd" => match zstd::stream::read::Decoder::with_buffer(self.data) {
                Ok(decoder) => decoder.take(limit).read_to_end(&mut out),
                Err(e) => Err(e),
            },
            _ => lz4_flex::frame::FrameDecoder::new(self.data).take(limit).read_to_end(&mut out),
        };
        if !self.whole {
            return Some(out);
        }
        let fits = read.is_ok() && out.len() as u64 == self.unpacked_size;
        (fits && (self.crc == 0 || crc32fast::hash(&out) == self.crc)).then_some(out)
    }

    /// Whether the file holds all of it.
    pub(crate) fn is_whole(&self) -> bool {
        self.whole
    }
}
