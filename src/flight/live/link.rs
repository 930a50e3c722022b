//! States as they arrive: which are usable, which is the newest, how old it is.

use super::packet::{Sight, read};
use crate::race::onboard::Estimate;

/// Packets so far, and the newest usable one.
#[derive(Clone, Debug, Default)]
pub struct Link {
    newest: Option<(f64, Sight)>,
    /// Least difference between arrival and the sender's clock, s: the fastest packet's.
    offset_s: Option<f64>,
    pub received: u64,
    /// Packets that were no states, that held numbers that are none, and that came twice or after a later one.
    pub foreign: u64,
    pub unusable: u64,
    pub late: u64,
    /// Packets that were sent and did not arrive, by their numbers.
    pub lost: u64,
}

/// Positions (m), speeds and rates beyond this are no measurements.
const LARGEST: f32 = 1e4;

impl Link {
    /// A packet that arrived at `now_s`; the state, if it is usable and newer than all before.
    pub fn receive(&mut self, bytes: &[u8], now_s: f64) -> Option<Sight> {
        self.received += 1;
        let Some(sight) = read(bytes) else {
            self.foreign += 1;
            return None;
        };
        if !usable(&sight.estimate) {
            self.unusable += 1;
            return None;
        }
        if let Some((_, last)) = &self.newest {
            // Numbers go round.
            let ahead = sight.number.wrapping_sub(last.number);
            if ahead == 0 || ahead > u32::MAX / 2 {
                self.late += 1;
                return None;
            }
            self.lost += u64::from(ahead - 1);
        }
        let offset_s = now_s - sight.time_us as f64 * 1e-6;
        self.offset_s = Some(self.offset_s.map_or(offset_s, |least| least.min(offset_s)));
        self.newest = Some((now_s, sight));
        Some(sight)
    }

    /// The newest usable state.
    pub fn newest(&self) -> Option<Sight> {
        self.newest.map(|(_, sight)| sight)
    }

    /// Its time by the sender's clock.
    pub fn time_us(&self) -> u64 {
        self.newest.map_or(0, |(_, sight)| sight.time_us)
    }

    /// Its age at `now_s`, s: since it arrived, and how much longer it was under way than the fastest packet.
    pub fn age_s(&self, now_s: f64) -> f64 {
        self.newest
            .zip(self.offset_s)
            .map_or(f64::INFINITY, |((_, sight), offset_s)| now_s - sight.time_us as f64 * 1e-6 - offset_s)
    }
}

fn usable(e: &Estimate) -> bool {
    let numbers = [e.position.as_slice(), &e.velocity, &e.attitude, &e.body_rates, &[e.voltage]].concat();
    let norm = e.attitude.iter().map(|q| q * q).sum::<f32>();
    numbers.iter().all(|x| x.abs() < LARGEST) && (0.98..1.02).contains(&norm)
}
