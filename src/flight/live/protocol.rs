//! What a protocol is to a flight: a translator with neither socket nor clock.

use super::answer::Answer;
use super::heard::Heard;

/// Bytes that arrive become [`Heard`], answers become bytes.
pub trait Protocol {
    /// Bytes as they came at `now_s`: a datagram, or any piece of a stream.
    fn hear(&mut self, bytes: &[u8], now_s: f64) -> Vec<Heard>;

    /// The bytes to send in the period that begins at `now_s`; none to send nothing.
    fn say(&mut self, answer: &Answer, now_s: f64) -> Vec<u8>;
}
