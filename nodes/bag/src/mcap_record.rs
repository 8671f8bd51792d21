//! Records of an MCAP file: put together and taken apart. Numbers are little-endian, texts have their length in front.

/// First and last eight bytes of a file.
pub(crate) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";

/// Kinds of records.
pub(crate) mod op {
    pub(crate) const HEADER: u8 = 0x01;
    pub(crate) const FOOTER: u8 = 0x02;
    pub(crate) const SCHEMA: u8 = 0x03;
    pub(crate) const CHANNEL: u8 = 0x04;
    pub(crate) const MESSAGE: u8 = 0x05;
    pub(crate) const CHUNK: u8 = 0x06;
    pub(crate) const MESSAGE_INDEX: u8 = 0x07;
    pub(crate) const CHUNK_INDEX: u8 = 0x08;
    pub(crate) const STATISTICS: u8 = 0x0B;
    pub(crate) const SUMMARY_OFFSET: u8 = 0x0E;
    pub(crate) const DATA_END: u8 = 0x0F;
}

/// Appends the parts of records.
pub(crate) trait Put {
    fn u16(&mut self, v: u16) -> &mut Self;
    fn u32(&mut self, v: u32) -> &mut Self;
    fn u64(&mut self, v: u64) -> &mut Self;
    fn text(&mut self, v: &str) -> &mut Self;
    /// A whole record: its kind, its length and what `body` appends.
    fn record(&mut self, op: u8, body: impl FnOnce(&mut Self)) -> &mut Self;
}

impl Put for Vec<u8> {
    fn u16(&mut self, v: u16) -> &mut Self {
        self.extend_from_slice(&v.to_le_bytes());
        self
    }

    fn u32(&mut self, v: u32) -> &mut Self {
        self.extend_from_slice(&v.to_le_bytes());
        self
    }

    fn u64(&mut self, v: u64) -> &mut Self {
        self.extend_from_slice(&v.to_le_bytes());
        self
    }

    fn text(&mut self, v: &str) -> &mut Self {
        self.u32(v.len() as u32);
        self.extend_from_slice(v.as_bytes());
        self
    }

    fn record(&mut self, op: u8, body: impl FnOnce(&mut Self)) -> &mut Self {
        self.push(op);
        let at = self.len();
        self.u64(0);
        body(self);
        let length = (self.len() - at - 8) as u64;
        self[at..at + 8].copy_from_slice(&length.to_le_bytes());
        self
    }
}

/// Takes the parts of a record off its front; `None` where it is too short.
#[derive(Clone, Copy)]
pub(crate) struct Parts<'a>(pub(crate) &'a [u8]);

impl<'a> Parts<'a> {
    pub(crate) fn bytes(&mut self, n: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(n)?;
        self.0 = tail;
        Some(head)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.bytes(1).map(|b| b[0])
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.bytes(2)?.try_into().ok().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.bytes(4)?.try_into().ok().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.bytes(8)?.try_into().ok().map(u64::from_le_bytes)
    }

    pub(crate) fn text(&mut self) -> Option<&'a str> {
        let n = self.u32()? as usize;
        std::str::from_utf8(self.bytes(n)?).ok()
    }

    /// A record within a chunk: its kind and body.
    pub(crate) fn record(&mut self) -> Option<(u8, Self)> {
        let op = self.u8()?;
        let n = usize::try_from(self.u64()?).ok()?;
        Some((op, Self(self.bytes(n)?)))
    }
}

/// A schema record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SchemaRecord {
    pub(crate) id: u16,
    pub(crate) name: String,
    pub(crate) encoding: String,
    pub(crate) text: String,
}

impl SchemaRecord {
    pub(crate) fn parse(mut p: Parts<'_>) -> Option<Self> {
        Some(Self {
            id: p.u16()?,
            name: p.text()?.to_owned(),
            encoding: p.text()?.to_owned(),
            text: p.text()?.to_owned(),
        })
    }

    pub(crate) fn put(&self, out: &mut Vec<u8>) {
        out.record(op::SCHEMA, |r| {
            r.u16(self.id).text(&self.name).text(&self.encoding).text(&self.text);
        });
    }
}

/// A channel record: a topic with its schema.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ChannelRecord {
    pub(crate) id: u16,
    pub(crate) schema: u16,
    pub(crate) topic: String,
    pub(crate) encoding: String,
    pub(crate) metadata: Vec<(String, String)>,
}

impl ChannelRecord {
    pub(crate) fn parse(mut p: Parts<'_>) -> Option<Self> {
        let (id, schema) = (p.u16()?, p.u16()?);
        let (topic, encoding) = (p.text()?.to_owned(), p.text()?.to_owned());
        let n = p.u32()? as usize;
        let mut map = Parts(p.bytes(n)?);
        let mut metadata = Vec::new();
        while !map.0.is_empty() {
            metadata.push((map.text()?.to_owned(), map.text()?.to_owned()));
        }
        Some(Self { id, schema, topic, encoding, metadata })
    }

    pub(crate) fn put(&self, out: &mut Vec<u8>) {
        out.record(op::CHANNEL, |r| {
            r.u16(self.id).u16(self.schema).text(&self.topic).text(&self.encoding);
            let mut map = Vec::new();
            for (key, value) in &self.metadata {
                map.text(key).text(value);
            }
            r.u32(map.len() as u32).extend_from_slice(&map);
        });
    }
}
