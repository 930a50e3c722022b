//! racer's own packets, over UDP: little-endian, one state or one answer each.
//!
//! | state, 76 bytes | | answer, 48 bytes | |
//! |---|---|---|---|
//! | 0 | `RST1` | 0 | `RSP1` |
//! | 4 | u32 number of the packet | 4 | u32 phase: 0 waiting, 1 ready, 2 flying, 3 ended |
//! | 8 | u64 time of the state, us, by the sender's clock | 8 | u64 time of the state that is answered, us |
//! | 16 | 3 f32 position, world, m | 16 | u32 reason, see [`Reason::code`] |
//! | 28 | 3 f32 velocity, world, m/s | 20 | u32 1 where the setpoint is to be flown, else 0 |
//! | 40 | 4 f32 attitude w, x, y, z, body to world | 24 | 3 f32 body rates, rad/s |
//! | 56 | 3 f32 body rates, rad/s | 36 | f32 throttle, 0 to 1 |
//! | 68 | f32 voltage, V; NaN where it is not known | 40 | f32 thrust, N |
//! | 72 | u32 bit 0: the dead man's switch is held | 44 | f32 thrust over the weight |

use super::answer::Answer;
use super::heard::{Heard, Sight};
use super::phase::Reason;
use super::protocol::Protocol;
use crate::race::onboard::{Estimate, Setpoint};

pub const STATE_BYTES: usize = 76;
pub const ANSWER_BYTES: usize = 48;
const STATE_MARK: &[u8; 4] = b"RST1";
const ANSWER_MARK: &[u8; 4] = b"RSP1";
/// How long the switch in a packet is believed, s: as long as anything that stands in it.
const SWITCH_S: f64 = 0.5;

/// What was seen of the packets' numbers, and what the packets are for.
#[derive(Clone, Copy, Debug)]
pub struct Packets {
    last: Option<u32>,
    switch: bool,
    answers: bool,
}

impl Packets {
    /// `switch` is whether their bit is the dead man's switch, `answers` whether any are sent.
    pub fn new(switch: bool, answers: bool) -> Self {
        Self { last: None, switch, answers }
    }

    /// How many packets are missing before number `number`. Numbers go round.
    fn missing(&mut self, number: u32) -> u32 {
        let ahead = self.last.map_or(1, |last| number.wrapping_sub(last));
        if ahead == 0 || ahead > u32::MAX / 2 {
            return 0;
        }
        self.last = Some(number);
        ahead - 1
    }
}

impl Protocol for Packets {
    fn hear(&mut self, bytes: &[u8], _: f64) -> Vec<Heard> {
        let Some((number, sight, held)) = read(bytes) else { return vec![Heard::Foreign] };
        let mut heard = Vec::new();
        match self.missing(number) {
            0 => {}
            missing => heard.push(Heard::Lost(missing.into())),
        }
        if self.switch {
            heard.push(Heard::Switch { held, for_s: SWITCH_S });
        }
        heard.push(Heard::State(sight));
        heard
    }

    fn say(&mut self, answer: &Answer, _: f64) -> Vec<u8> {
        if !self.answers {
            return Vec::new();
        }
        let none = Setpoint { body_rates: [0.0; 3], throttle: 0.0, thrust_n: 0.0, thrust_to_weight: 0.0 };
        let s = answer.setpoint.unwrap_or(none);
        let [x, y, z] = s.body_rates;
        let mut out = Vec::with_capacity(ANSWER_BYTES);
        out.extend(ANSWER_MARK);
        out.extend((answer.phase as u32).to_le_bytes());
        out.extend(answer.time_us.to_le_bytes());
        out.extend(answer.reason.map_or(0, Reason::code).to_le_bytes());
        out.extend(u32::from(answer.setpoint.is_some()).to_le_bytes());
        [x, y, z, s.throttle, s.thrust_n, s.thrust_to_weight].iter().for_each(|x| out.extend(x.to_le_bytes()));
        out
    }
}

/// Number, state and switch of a packet; none where it is no such packet.
fn read(bytes: &[u8]) -> Option<(u32, Sight, bool)> {
    if bytes.len() != STATE_BYTES || !bytes.starts_with(STATE_MARK) {
        return None;
    }
    let word = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
    let floats = |at: usize| std::array::from_fn(|i| f32::from_bits(word(at + 4 * i)));
    let [w, x, y, z] = std::array::from_fn(|i| f32::from_bits(word(40 + 4 * i)));
    let estimate = Estimate {
        position: floats(16),
        velocity: floats(28),
        attitude: [w, x, y, z],
        body_rates: floats(56),
        voltage: f32::from_bits(word(68)),
    };
    let time_us = u64::from(word(8)) | u64::from(word(12)) << 32;
    Some((word(4), Sight { time_us, estimate }, word(72) & 1 == 1))
}

/// The packet of a state.
#[cfg(feature = "internals")]
pub fn state(number: u32, sight: &Sight, switch: bool) -> Vec<u8> {
    let e = &sight.estimate;
    let mut out = [STATE_MARK.as_slice(), &number.to_le_bytes(), &sight.time_us.to_le_bytes()].concat();
    let parts: [&[f32]; 5] = [&e.position, &e.velocity, &e.attitude, &e.body_rates, &[e.voltage]];
    parts.concat().iter().for_each(|x| out.extend(x.to_le_bytes()));
    out.extend(u32::from(switch).to_le_bytes());
    out
}

#[cfg(test)]
mod tests {
    use super::super::phase::Phase;
    use super::*;

    #[test]
    fn what_is_no_packet_is_foreign() {
        let estimate = Estimate {
            position: [1.0, 2.0, 3.0],
            velocity: [4.0, 5.0, 6.0],
            attitude: [1.0, 0.0, 0.0, 0.0],
            body_rates: [7.0, 8.0, 9.0],
            voltage: 24.5,
        };
        let mut packet = STATE_MARK.to_vec();
        packet.extend(7u32.to_le_bytes());
        packet.extend((1u64 << 40).to_le_bytes());
        for x in [1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0, 1.0, 0.0, 0.0, 0.0, 7.0, 8.0, 9.0, 24.5] {
            packet.extend(x.to_le_bytes());
        }
        packet.extend(1u32.to_le_bytes());
        let mut packets = Packets::new(true, true);
        let state = Heard::State(Sight { time_us: 1 << 40, estimate });
        let switch = Heard::Switch { held: true, for_s: SWITCH_S };
        assert_eq!(packets.hear(&packet, 0.0), [switch, state]);
        packet[4] = 10;
        assert_eq!(packets.hear(&packet, 0.0), [Heard::Lost(2), switch, state]);
        assert_eq!(Packets::new(false, true).hear(&packet, 0.0), [state]);
        assert_eq!(packets.hear(&packet[..75], 0.0), [Heard::Foreign]);
        packet[0] = b'X';
        assert_eq!(packets.hear(&packet, 0.0), [Heard::Foreign]);
        let reason = Some(Reason::Stale);
        let answer = Answer { phase: Phase::Ended, reason, armed: false, time_us: 5, setpoint: None };
        let bytes = packets.say(&answer, 0.0);
        assert_eq!((bytes.len(), bytes[4], bytes[8], bytes[20]), (ANSWER_BYTES, 3, 5, 0));
    }
}
