//! Frames of MSP, version 1: `$M<`, length, command, payload, exclusive or of all from the length on. Source: the MSP
//! page of Betaflight's documentation.

/// What stands before a request, an answer, and the answer that a request was not understood.
const REQUEST: &[u8; 3] = b"$M<";
const ANSWER: &[u8; 3] = b"$M>";
const REFUSAL: &[u8; 3] = b"$M!";
/// Bytes of a frame around its payload.
const AROUND: usize = 6;

fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

/// The frame that asks a flight controller for `command`.
///
/// # Panics
///
/// With more than 255 bytes of payload, which a frame cannot have.
pub fn request(command: u8, payload: &[u8]) -> Vec<u8> {
    let length = u8::try_from(payload.len()).expect("a payload of one frame");
    let mut frame = [REQUEST.as_slice(), &[length, command], payload].concat();
    frame.push(checksum(&frame[REQUEST.len()..]));
    frame
}

/// What a flight controller answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reply {
    pub command: u8,
    /// Whether it did not understand, or would not.
    pub refused: bool,
    pub payload: Vec<u8>,
}

/// Answers, found in a stream of bytes. It keeps less than one frame.
#[derive(Clone, Debug, Default)]
pub struct Replies {
    rest: Vec<u8>,
    /// Bytes of no frame so far: text of a console, damaged frames.
    pub foreign: u64,
}

impl Replies {
    /// The answers that end in `bytes`.
    pub fn hear(&mut self, bytes: &[u8]) -> Vec<Reply> {
        self.rest.extend(bytes);
        let (mut at, mut replies) = (0, Vec::new());
        while let Some(found) = frame(&self.rest[at..]) {
            match found {
                Beginning::Foreign => {
                    self.foreign += 1;
                    at += 1;
                }
                Beginning::Whole(reply) => {
                    at += AROUND + reply.payload.len();
                    replies.push(reply);
                }
            }
        }
        self.rest.drain(..at);
        replies
    }
}

enum Beginning {
    /// The first byte begins no frame.
    Foreign,
    Whole(Reply),
}

/// What is at the beginning of `bytes`; none where more of them have to come to tell.
fn frame(bytes: &[u8]) -> Option<Beginning> {
    let mark = &bytes[..bytes.len().min(3)];
    if ![ANSWER, REFUSAL].iter().any(|whole| whole.starts_with(mark)) {
        return Some(Beginning::Foreign);
    }
    let length = usize::from(*bytes.get(3)?);
    let whole = bytes.get(..AROUND + length)?;
    if checksum(&whole[3..]) != 0 {
        return Some(Beginning::Foreign);
    }
    let payload = whole[5..5 + length].to_vec();
    Some(Beginning::Whole(Reply { command: whole[4], refused: mark == REFUSAL, payload }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(mark: &[u8], command: u8, payload: &[u8]) -> Vec<u8> {
        let mut frame = request(command, payload);
        frame[..3].copy_from_slice(mark);
        frame
    }

    #[test]
    fn a_request_is_as_the_documentation_has_it() {
        // MSP_API_VERSION without payload, and one with two bytes.
        assert_eq!(request(1, &[]), [b'$', b'M', b'<', 0, 1, 1]);
        assert_eq!(request(200, &[0xdc, 0x05]), [b'$', b'M', b'<', 2, 200, 0xdc, 5, 2 ^ 200 ^ 0xdc ^ 5]);
    }

    #[test]
    fn answers_are_found_between_other_bytes_however_they_are_cut() {
        let good = answer(b"$M>", 105, &[1, 2, 3]);
        let mut damaged = good.clone();
        damaged[6] ^= 1;
        let stream = [b"# $M boot\r\n".as_slice(), &good, &damaged, &answer(b"$M!", 7, &[]), b"$M>"].concat();
        let wanted = [
            Reply { command: 105, refused: false, payload: vec![1, 2, 3] },
            Reply { command: 7, refused: true, payload: vec![] },
        ];
        for cut in 1..stream.len() {
            let mut replies = Replies::default();
            let found: Vec<_> = stream.chunks(cut).flat_map(|bytes| replies.hear(bytes)).collect();
            assert_eq!(found, wanted, "in pieces of {cut}");
            assert_eq!((replies.foreign, replies.rest.as_slice()), (11 + 9, b"$M>".as_slice()));
        }
    }
}
