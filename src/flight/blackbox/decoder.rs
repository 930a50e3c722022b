//! Reads the frames of a flight in order, and finds its way again where they are damaged.
//!
//! A frame counts where it is followed by the letter of another, or by the end; else the next is looked for one byte
//! further on. After damage, differences mean nothing until the next whole frame. blackbox_decode does the same.

use super::bytes::FrameBytes;
use super::definition::{Definitions, FrameDefinition};
use super::event::{Event, LOG_END, LOGGING_RESUME};
use super::header::Header;
use super::predictor::Past;
use super::sequence::FrameSequence;
use super::tally::ByteTally;
use std::ops::Range;

/// A frame that was read: numbers as recorded, in the order of its definition.
pub enum DecodedFrame<'a> {
    Main(&'a [i64]),
    Gps(&'a [i64]),
    Slow(&'a [i64]),
    Event(Event),
}

pub struct FrameDecoder<'a> {
    /// Without the padding that follows it.
    bytes: &'a [u8],
    definitions: &'a Definitions,
    inav: bool,
    main: FrameSequence,
    gps: Vec<i64>,
    gps_time: Option<usize>,
    slow: Vec<i64>,
    /// The last home position, and the one that is being read.
    home: Vec<i64>,
    next_home: Vec<i64>,
    home_known: bool,
    /// The bytes before were no frame.
    searching: bool,
    tally: ByteTally,
}

impl<'a> FrameDecoder<'a> {
    /// Fails where main frames have no iteration or time.
    pub fn new(bytes: &'a [u8], header: &Header, definitions: &'a Definitions) -> Result<Self, String> {
        let zeros = |definition: &FrameDefinition| vec![0; definition.names.len()];
        // Flash memory that was never written.
        let content = bytes.iter().rposition(|byte| *byte != 0xff).map_or(0, |last| last + 1);
        Ok(Self {
            bytes: &bytes[..content],
            definitions,
            inav: header.inav(),
            main: FrameSequence::new(&definitions.intra.names, header)?,
            gps: zeros(&definitions.gps),
            gps_time: definitions.gps.names.iter().position(|name| name == "time"),
            slow: zeros(&definitions.slow),
            home: zeros(&definitions.home),
            next_home: zeros(&definitions.home),
            home_known: false,
            searching: false,
            tally: ByteTally::new(content),
        })
    }

    /// Reads from `start` on, and gives every frame with its time in microseconds to `sink`.
    pub fn run(mut self, start: usize, mut sink: impl FnMut(i64, DecodedFrame)) -> ByteTally {
        // More frames would be shorter than any firmware writes them, and only fill the memory.
        let mut room = self.bytes.len() / 4 + 1024;
        let mut at = start;
        self.tally.end = start;
        while at < self.bytes.len() && !self.tally.closed {
            let letter = self.bytes[at];
            let mut bytes = FrameBytes::new(self.bytes, at + 1);
            let event = self.read(letter, &mut bytes).filter(|event| self.ends(event, bytes.at));
            let Some(event) = event else {
                (self.main.valid, self.searching) = (false, true);
                self.tally.lose(matches!(letter, b'I' | b'P'), 1);
                at += 1;
                continue;
            };
            if room == 0 {
                self.tally.crowded = true;
                break;
            }
            room -= 1;
            self.searching = false;
            self.complete(letter, event, at..bytes.at, &mut sink);
            at = bytes.at;
        }
        self.tally
    }

    /// Reads a frame behind its letter. `None` where there is no such frame, or it breaks off; else the event, if it is
    /// one, and whether its kind is known.
    fn read(&mut self, letter: u8, bytes: &mut FrameBytes) -> Option<Option<(Event, bool)>> {
        let Definitions { intra, inter, gps, home, slow } = self.definitions;
        let past = Past { previous: None, before: None, home: &self.home, main_time: self.main.time(), skipped: 0 };
        match letter {
            b'I' | b'P' => {
                let (current, past) = self.main.next(letter == b'I', &self.home);
                (if letter == b'I' { intra } else { inter }).read(bytes, current, &past)?;
            }
            b'G' if !gps.names.is_empty() => gps.read(bytes, &mut self.gps, &past)?,
            b'H' if !home.names.is_empty() => home.read(bytes, &mut self.next_home, &past)?,
            b'S' if !slow.names.is_empty() => slow.read(bytes, &mut self.slow, &past)?,
            b'E' => return Some(Some(Event::read(bytes, self.inav)?)),
            _ => return None,
        }
        Some(None)
    }

    /// Whether a frame that was read up to `at` looks whole. What only ends where the bytes do, and had to be searched
    /// for, is more likely a part of a frame that was cut off.
    fn ends(&self, event: &Option<(Event, bool)>, at: usize) -> bool {
        let closing = matches!(event, Some((Event { kind: LOG_END, .. }, true)));
        closing || self.bytes.get(at).map_or(!self.searching, |next| b"IPGHSE".contains(next))
    }

    fn complete(
        &mut self,
        letter: u8,
        event: Option<(Event, bool)>,
        range: Range<usize>,
        sink: &mut impl FnMut(i64, DecodedFrame),
    ) {
        let now = self.main.last.map_or(0, |(_, time)| time);
        match (letter, event) {
            (b'I' | b'P', _) => match self.main.accept(letter == b'I') {
                Some(time) => {
                    self.tally.frames += 1;
                    self.tally.settle(range.end);
                    sink(time, DecodedFrame::Main(self.main.latest()));
                }
                None => self.tally.lose(true, range.len()),
            },
            (b'G', _) => {
                let time = self.gps_time.map_or(now, |i| self.main.unwrapped(self.gps[i]));
                if self.home_known {
                    sink(time, DecodedFrame::Gps(&self.gps));
                } else {
                    self.tally.homeless += 1;
                }
            }
            (b'H', _) => {
                self.home.copy_from_slice(&self.next_home);
                self.home_known = true;
            }
            (b'S', _) => sink(now, DecodedFrame::Slow(&self.slow)),
            (_, Some((event, true))) => {
                match event.kind {
                    LOGGING_RESUME => self.main.resume(event.first as u32, event.second as u32),
                    LOG_END => {
                        self.tally.closed = true;
                        self.tally.settle(range.end);
                    }
                    _ => {}
                }
                sink(now, DecodedFrame::Event(event));
            }
            _ => {}
        }
    }
}
