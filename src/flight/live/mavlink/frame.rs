//! Frames of MAVLink 2: 0xFD, length, two flags, sequence, system, component, three bytes of identifier, payload
//! without its trailing zeros, CRC-16/MCRF4XX of all that and of a number that stands for the message's definition.
//! Source: mavlink.io/en/guide/serialization.html.

use super::message::extra;

const MARK: u8 = 0xfd;
/// Bytes before the payload, of the checksum, and of the signature that some frames end with.
const HEADER: usize = 10;
const CHECKSUM: usize = 2;
const SIGNATURE: usize = 13;
/// Flag of a signed frame; one with any other flag is laid out in a way that is not known here.
const SIGNED: u8 = 1;

/// One message between its frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MavFrame {
    /// Goes round at 256, over all messages of its sender.
    pub sequence: u8,
    /// System and component.
    pub sender: [u8; 2],
    pub id: u32,
    /// With what was cut off its end: as long as the longest.
    pub payload: [u8; 255],
}

/// What was found in a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
// A frame is looked at once and dropped; it stays off the heap, whose time is not bounded.
#[allow(clippy::large_enum_variant)]
pub enum Scanned {
    /// A message that racer knows, undamaged.
    Known(MavFrame),
    /// A message that it does not know, whose checksum cannot be told therefore: sequence and sender.
    Other(u8, [u8; 2]),
    /// Bytes of no frame, or a damaged one.
    Foreign,
}

fn checksum(bytes: &[u8], extra: u8) -> u16 {
    bytes.iter().chain([&extra]).fold(0xffff, |crc, byte| {
        let low = *byte ^ crc as u8;
        let mixed = u16::from(low ^ low << 4);
        crc >> 8 ^ mixed << 8 ^ mixed << 3 ^ mixed >> 4
    })
}

/// The frame of a message that racer knows.
pub fn frame(sequence: u8, [system, component]: [u8; 2], id: u32, payload: &[u8]) -> Vec<u8> {
    // The first byte is sent even where it is zero.
    let length = payload.iter().rposition(|byte| *byte != 0).map_or(1, |last| last + 1);
    let [low, middle, high, _] = id.to_le_bytes();
    let mut out = vec![MARK, length as u8, 0, 0, sequence, system, component, low, middle, high];
    out.extend(&payload[..length]);
    let crc = checksum(&out[1..], extra(id).unwrap_or(0));
    out.extend(crc.to_le_bytes());
    out
}

/// Frames, found in a stream of bytes. It keeps less than one frame.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    rest: Vec<u8>,
}

impl Frames {
    /// What ends in `bytes`, in order.
    pub fn hear(&mut self, bytes: &[u8]) -> Vec<Scanned> {
        self.rest.extend(bytes);
        let (mut at, mut all) = (0, Vec::new());
        while let Some((found, length)) = first(&self.rest[at..]) {
            at += length;
            // Garbage is one thing, however long.
            if found != Scanned::Foreign || all.last() != Some(&Scanned::Foreign) {
                all.push(found);
            }
        }
        self.rest.drain(..at);
        all
    }
}

/// What `bytes` begin with, and its length; none where more of them have to come to tell.
fn first(bytes: &[u8]) -> Option<(Scanned, usize)> {
    match bytes {
        [] => return None,
        [MARK, _, flags, ..] if flags & !SIGNED == 0 => {}
        [MARK] | [MARK, _] => return None,
        _ => {
            return Some((Scanned::Foreign, bytes[1..].iter().position(|b| *b == MARK).map_or(bytes.len(), |n| n + 1)));
        }
    }
    let (length, signed) = (usize::from(bytes[1]), bytes[2] & SIGNED != 0);
    let whole = bytes.get(..HEADER + length + CHECKSUM + if signed { SIGNATURE } else { 0 })?;
    let (sequence, sender) = (whole[4], [whole[5], whole[6]]);
    let id = u32::from_le_bytes([whole[7], whole[8], whole[9], 0]);
    let Some(extra) = extra(id) else { return Some((Scanned::Other(sequence, sender), whole.len())) };
    let end = HEADER + length;
    if checksum(&whole[1..end], extra).to_le_bytes() != whole[end..end + CHECKSUM] {
        return Some((Scanned::Foreign, 1));
    }
    let mut payload = [0; 255];
    payload[..length].copy_from_slice(&whole[HEADER..end]);
    Some((Scanned::Known(MavFrame { sequence, sender, id, payload }), whole.len()))
}

#[cfg(test)]
mod tests {
    use super::super::message::HEARTBEAT;
    use super::*;

    #[test]
    fn the_checksum_is_the_one_of_the_catalogue() {
        // The check value of CRC-16/MCRF4XX: of the digits one to nine.
        assert_eq!(checksum(b"12345678", b'9'), 0x6f91);
    }

    #[test]
    fn frames_are_found_between_other_bytes_however_they_are_cut() {
        let good = frame(7, [1, 1], HEARTBEAT, &[0, 0, 6, 0, 2, 12, 0xd1, 4, 3]);
        let short = frame(8, [1, 1], HEARTBEAT, &[0; 9]);
        assert_eq!(short.len(), HEADER + 1 + CHECKSUM);
        let mut damaged = good.clone();
        damaged[12] ^= 4;
        // A message that nobody knows, with a mark inside.
        let other = [MARK, 3, 0, 0, 9, 1, 1, 0xff, 0xff, 0xff, MARK, 0xff, 0, 0, 0];
        let stream = [b"boot\r\n".as_slice(), &good, &damaged, b"..", &other, &short, &good[..5]].concat();
        for cut in 1..stream.len() {
            let mut frames = Frames::default();
            let mut found: Vec<_> = stream.chunks(cut).flat_map(|bytes| frames.hear(bytes)).collect();
            found.retain(|found| *found != Scanned::Foreign);
            let [Scanned::Known(first), Scanned::Other(9, [1, 1]), Scanned::Known(second)] = found.as_slice() else {
                panic!("in pieces of {cut}: {found:?}")
            };
            assert_eq!((first.sequence, first.payload[6], second.sequence), (7, 0xd1, 8));
            assert_eq!(frames.rest, good[..5]);
        }
    }
}
