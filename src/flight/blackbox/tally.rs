//! What became of the bytes of a flight.

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ByteTally {
    /// Main frames that count.
    pub frames: usize,
    /// Main frames that do not, and bytes that belong to no frame, before the last one that counts.
    pub lost: usize,
    pub lost_bytes: usize,
    /// GPS frames before the first home position, which they are relative to.
    pub homeless: usize,
    /// Where the last frame ends that counts.
    pub end: usize,
    /// Bytes before the padding.
    pub content: usize,
    /// The firmware says that the log ends here.
    pub closed: bool,
    /// There are more frames than so many bytes can have; what follows was not read.
    pub crowded: bool,
    /// Lost since the last frame that counts: frames and bytes.
    pending: (usize, usize),
}

impl ByteTally {
    pub fn new(content: usize) -> Self {
        Self { content, ..Self::default() }
    }

    /// Bytes that belong to no frame that counts, perhaps those of a main frame.
    pub fn lose(&mut self, frame: bool, bytes: usize) {
        self.pending.0 += usize::from(frame);
        self.pending.1 += bytes;
    }

    /// A frame that counts ends here: what was lost so far was lost within the log, not behind its end.
    pub fn settle(&mut self, end: usize) {
        self.lost += self.pending.0;
        self.lost_bytes += self.pending.1;
        self.end = end;
        self.pending = (0, 0);
    }
}
