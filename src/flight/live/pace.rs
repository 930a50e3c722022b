//! A flight in real time: what arrived is heard, every 10 ms an answer is sent.

use super::Live;
use super::heard::Heard;
use super::histogram::Histogram;
use super::phase::{Phase, Reason};
use super::port::{Arrival, Port, WAITING};
use super::protocol::Protocol;
use crate::model::constants::CONTROL_S;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// How long the end is told after a flight, s.
const FAREWELL_S: f64 = 1.0;

/// How well real time was kept.
#[derive(Clone, Debug, Default)]
pub struct Timing {
    /// From when a period began to when the program woke, s.
    pub wake: Histogram,
    /// From waking to the answer's being sent, s.
    pub answer: Histogram,
    /// Periods whose answer was sent after the next one had begun.
    pub missed: u64,
}

/// A protocol over a port.
pub struct Line {
    pub protocol: Box<dyn Protocol>,
    pub port: Box<dyn Port>,
}

/// Who is asked, and told, during a flight.
pub struct User<'a> {
    /// Whether the user asks for an end.
    pub key: &'a dyn Fn() -> bool,
    /// Hears of every change.
    pub told: &'a mut dyn FnMut(Phase, Option<Reason>),
}

/// Flies until it has ended or `most_s` are over. The first of the `lines` brings states; what comes by any has
/// `arrived`.
pub fn fly(live: &mut Live, lines: &mut [Line], arrived: &Receiver<Arrival>, most_s: f64, user: &mut User) -> Timing {
    let begun = Instant::now();
    let mut timing = Timing::default();
    let (mut last, mut ended_s, mut period) = (None, None, 0u64);
    loop {
        let planned_s = period as f64 * CONTROL_S;
        std::thread::sleep(Duration::from_secs_f64((planned_s - begun.elapsed().as_secs_f64()).max(0.0)));
        let woke_s = begun.elapsed().as_secs_f64();
        // No more than can have waited: a flood must not keep an answer back.
        for Arrival { line, at, bytes } in arrived.try_iter().take(WAITING) {
            let at_s = at.saturating_duration_since(begun).as_secs_f64();
            for heard in lines[line].protocol.hear(&bytes, at_s) {
                // Where the vehicle is, only the first says.
                if line == 0 || matches!(heard, Heard::Voltage(_) | Heard::Switch { .. }) {
                    live.receive(heard, at_s);
                }
            }
        }
        let mut answer = live.tick(woke_s, (user.key)() || woke_s > most_s);
        for line in lines.iter_mut() {
            let bytes = line.protocol.say(&answer, woke_s);
            if !bytes.is_empty() && line.port.send(&bytes).is_err() {
                live.machine.end(Reason::LinkLost);
                (answer.phase, answer.reason) = (live.machine.phase, live.machine.reason);
            }
        }
        let sent_s = begun.elapsed().as_secs_f64();
        timing.wake.add(woke_s - planned_s);
        timing.answer.add(sent_s - woke_s);
        // Periods that are over are left out: an answer to the past helps nobody.
        let next = (sent_s / CONTROL_S) as u64 + 1;
        timing.missed += next - (period + 1).min(next);
        period = next.max(period + 1);
        let now = (answer.phase, answer.reason);
        if last != Some(now) {
            (user.told)(now.0, now.1);
            last = Some(now);
        }
        if answer.phase == Phase::Ended && sent_s - *ended_s.get_or_insert(sent_s) > FAREWELL_S {
            return timing;
        }
    }
}
