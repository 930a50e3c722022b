//! States as they arrive: which are usable, which is the newest, how old it is.

use super::heard::{Heard, Sight};
use crate::race::onboard::Estimate;

/// What arrived so far.
#[derive(Clone, Debug, Default)]
pub struct Link {
    newest: Option<Sight>,
    /// Least difference between arrival and the sender's clock, s: the fastest message's.
    offset_s: Option<f64>,
    /// The last voltage, V, and until when it is believed.
    voltage: Option<(f32, f64)>,
    /// Until when the dead man's switch is believed to be held.
    held_until_s: f64,
    /// States that arrived.
    pub received: u64,
    /// What was no state, states whose numbers are none, and states that came twice or after a later one.
    pub foreign: u64,
    pub unusable: u64,
    pub late: u64,
    /// Messages that were sent and did not arrive.
    pub lost: u64,
}

/// Positions (m), speeds and rates beyond this are no measurements.
const LARGEST: f32 = 1e4;
/// How long a voltage is believed, s: flight controllers send one in one or two seconds.
const VOLTAGE_S: f64 = 5.0;
/// A time so much before the last is no late message but a clock that began again, us.
const CLOCK_US: u64 = 1_000_000;

impl Link {
    /// What arrived at `now_s`; the state, if it is usable and newer than all before.
    pub fn receive(&mut self, heard: Heard, now_s: f64) -> Option<Sight> {
        match heard {
            Heard::State(sight) => return self.state(sight, now_s),
            Heard::Voltage(volts) => self.told(volts, now_s),
            Heard::Switch { held, for_s } => self.held_until_s = if held { now_s + for_s } else { 0.0 },
            Heard::Lost(messages) => self.lost += messages,
            Heard::Foreign => self.foreign += 1,
        }
        None
    }

    fn told(&mut self, volts: f32, now_s: f64) {
        if volts > 0.0 && volts < LARGEST {
            self.voltage = Some((volts, now_s + VOLTAGE_S));
        }
    }

    fn state(&mut self, mut sight: Sight, now_s: f64) -> Option<Sight> {
        self.received += 1;
        self.told(sight.estimate.voltage, now_s);
        if sight.estimate.voltage.is_nan() {
            sight.estimate.voltage = self.voltage.filter(|(_, until_s)| now_s < *until_s).map_or(f32::NAN, |v| v.0);
        }
        if !usable(&sight.estimate) {
            self.unusable += 1;
            return None;
        }
        let behind_us = self.newest.and_then(|last| last.time_us.checked_sub(sight.time_us));
        if behind_us.is_some_and(|us| us < CLOCK_US) {
            self.late += 1;
            return None;
        }
        if behind_us.is_some() {
            self.offset_s = None;
        }
        let offset_s = now_s - sight.time_us as f64 * 1e-6;
        self.offset_s = Some(self.offset_s.map_or(offset_s, |least| least.min(offset_s)));
        self.newest = Some(sight);
        Some(sight)
    }

    /// The newest usable state.
    pub fn newest(&self) -> Option<Sight> {
        self.newest
    }

    /// Whether the dead man's switch is held at `now_s`.
    pub fn held(&self, now_s: f64) -> bool {
        now_s < self.held_until_s
    }

    /// Age of the newest state at `now_s`, s: since it arrived, and how much longer it was under way than the fastest.
    pub fn age_s(&self, now_s: f64) -> f64 {
        self.newest
            .zip(self.offset_s)
            .map_or(f64::INFINITY, |(sight, offset_s)| now_s - sight.time_us as f64 * 1e-6 - offset_s)
    }
}

/// Whether these are measurements. The voltage may be missing: that is a reason of its own.
fn usable(e: &Estimate) -> bool {
    let voltage = if e.voltage.is_nan() { 0.0 } else { e.voltage };
    let numbers = [e.position.as_slice(), &e.velocity, &e.attitude, &e.body_rates, &[voltage]].concat();
    let norm = e.attitude.iter().map(|q| q * q).sum::<f32>();
    numbers.iter().all(|x| x.abs() < LARGEST) && (0.98..1.02).contains(&norm)
}
