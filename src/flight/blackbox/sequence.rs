//! The main frames of a flight one after the other: what the next is predicted from, and whether it can follow.

use super::header::Header;
use super::predictor::Past;

/// A frame that jumps further from the one before is damaged.
const MOST_ITERATIONS: u32 = 5000;
const MOST_TIME_US: i64 = 10_000_000;

pub struct FrameSequence {
    pub current: Vec<i64>,
    /// The last two frames, where `history` says that there are.
    previous: Vec<i64>,
    before: Vec<i64>,
    history: bool,
    /// Differences can be trusted: no damage since the last whole frame.
    pub valid: bool,
    /// Iteration and time of the last frame that counts.
    pub last: Option<(u32, i64)>,
    /// What the 32 bits of the clock have overflowed to.
    wrapped_us: i64,
    /// Places of iteration and time in a frame.
    iteration_at: usize,
    time_at: usize,
    interval: Interval,
}

impl FrameSequence {
    /// Fails where frames of the fields `names` have no iteration or time.
    pub fn new(names: &[String], header: &Header) -> Result<Self, String> {
        let place = |name: &str| {
            let found = names.iter().position(|known| known == name);
            found.ok_or_else(|| format!("no field `{name}` in its main frames"))
        };
        let frame = vec![0; names.len()];
        Ok(Self {
            current: frame.clone(),
            previous: frame.clone(),
            before: frame,
            history: false,
            valid: false,
            last: None,
            wrapped_us: 0,
            iteration_at: place("loopIteration")?,
            time_at: place("time")?,
            interval: Interval::of(header),
        })
    }

    /// The frame to be read, and what it is predicted from: a whole one never from two frames before.
    pub fn next<'s>(&'s mut self, whole: bool, home: &'s [i64]) -> (&'s mut [i64], Past<'s>) {
        let skipped = if whole { 0 } else { self.last.map_or(0, |(iteration, _)| self.interval.skipped(iteration)) };
        let past = Past {
            previous: self.history.then_some(&self.previous[..]),
            before: (self.history && !whole).then_some(&self.before[..]),
            home,
            main_time: self.time(),
            skipped: skipped as i64,
        };
        (&mut self.current, past)
    }

    /// Of the last frame, as far as predictions know.
    pub fn time(&self) -> i64 {
        if self.history { self.previous[self.time_at] } else { 0 }
    }

    /// The last frame that was accepted.
    pub fn latest(&self) -> &[i64] {
        &self.previous
    }

    /// Takes the frame that was read; its time, where it counts.
    pub fn accept(&mut self, whole: bool) -> Option<i64> {
        let time = self.unwrapped(self.current[self.time_at]);
        self.current[self.time_at] = time;
        let iteration = self.current[self.iteration_at] as u32;
        let follows = self.last.is_none_or(|(before, then)| {
            (before..before.wrapping_add(MOST_ITERATIONS)).contains(&iteration)
                && (then..then.saturating_add(MOST_TIME_US)).contains(&time)
        });
        if !(whole || self.valid) {
            return None;
        }
        self.valid = follows;
        self.history &= follows;
        if !follows {
            return None;
        }
        self.last = Some((iteration, time));
        self.wrapped_us = time - i64::from(time as u32);
        if whole {
            // Nothing reaches back beyond a whole frame: it stands for both.
            self.before.copy_from_slice(&self.current);
        } else {
            std::mem::swap(&mut self.before, &mut self.previous);
        }
        self.previous.copy_from_slice(&self.current);
        self.history = true;
        Some(time)
    }

    /// Logging went on at this iteration and time.
    pub fn resume(&mut self, iteration: u32, time: u32) {
        self.last = Some((iteration, i64::from(time) + self.wrapped_us));
    }

    /// A time near the last frame's, of which the file has 32 bits.
    pub fn unwrapped(&self, time: i64) -> i64 {
        let time = time as u32;
        let overflows = self
            .last
            .is_some_and(|(_, last)| time < last as u32 && i64::from(time.wrapping_sub(last as u32)) < MOST_TIME_US);
        i64::from(time) + self.wrapped_us + if overflows { 1 << 32 } else { 0 }
    }
}

/// Which iterations are logged: the first of every `whole`, and `share` of `of`.
struct Interval {
    whole: u64,
    share: u64,
    of: u64,
}

impl Interval {
    /// A P interval without a slash is taken for 1/1, as blackbox_decode does; between whole frames the field
    /// `loopIteration` then counts what was logged.
    fn of(header: &Header) -> Self {
        let ratio = header.text("P interval").and_then(|text| text.split_once('/'));
        let ratio = ratio.and_then(|(share, of)| Some((share.parse::<u32>().ok()?, of.parse::<u32>().ok()?)));
        let (share, of) = ratio.unwrap_or((1, 1));
        let whole = header.integer("I interval").unwrap_or(32).clamp(1, i64::from(u32::MAX)) as u64;
        Self { whole, share: share.max(1).into(), of: of.max(1).into() }
    }

    /// Iterations without a frame that follow `last`.
    fn skipped(&self, last: u32) -> u64 {
        let first = u64::from(last.wrapping_add(1)) % self.whole;
        let step = (first + self.share - 1) % self.of;
        if step < self.share { 0 } else { (self.of - step).min(self.whole - first) }
    }
}
