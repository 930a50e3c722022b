//! Serialized messages: CDR, little-endian.

/// Bytes before the message, which alignment does not count.
const HEADER: [u8; 4] = [0, 1, 0, 0];

/// A message being written.
pub struct Cdr(Vec<u8>);

impl Cdr {
    /// A message that begins with `std_msgs/Header`.
    pub fn new(stamp_ns: u64, frame: &str) -> Self {
        let mut cdr = Self(HEADER.into());
        for part in [stamp_ns / 1_000_000_000, stamp_ns % 1_000_000_000] {
            cdr.put((part as u32).to_le_bytes());
        }
        cdr.text(frame);
        cdr
    }

    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// A number, aligned to its size.
    fn put<const N: usize>(&mut self, number: [u8; N]) {
        let at = self.0.len() - HEADER.len();
        self.0.resize(HEADER.len() + at.next_multiple_of(N), 0);
        self.0.extend(number);
    }

    pub fn u8(&mut self, number: u8) {
        self.put([number]);
    }

    pub fn f32(&mut self, number: f64) {
        self.put((number as f32).to_le_bytes());
    }

    pub fn f64s(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.put(number.to_le_bytes());
        }
    }

    /// How many elements of a sequence follow.
    pub fn length(&mut self, n: usize) {
        self.put((n as u32).to_le_bytes());
    }

    pub fn text(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }
}
