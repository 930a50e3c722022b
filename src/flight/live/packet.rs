//! The packets of UDP: little-endian, one state or one answer each.
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
//! | 68 | f32 voltage, V | 40 | f32 thrust, N |
//! | 72 | u32 bit 0: the dead man's switch is held | 44 | f32 thrust over the weight |

use super::phase::{Phase, Reason};
use crate::race::onboard::{Estimate, Setpoint};

pub const STATE_BYTES: usize = 76;
pub const ANSWER_BYTES: usize = 48;
const STATE_MARK: &[u8; 4] = b"RST1";
const ANSWER_MARK: &[u8; 4] = b"RSP1";

/// A state as it was sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    pub number: u32,
    /// By the sender's clock.
    pub time_us: u64,
    pub estimate: Estimate,
    /// Whether the dead man's switch is held.
    pub switch: bool,
}

/// What is sent back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    pub phase: Phase,
    /// Why it is not ready, or why it ended.
    pub reason: Option<Reason>,
    /// Of the state that is answered, by its sender's clock.
    pub time_us: u64,
    /// None unless the policy flies.
    pub setpoint: Option<Setpoint>,
}

fn float(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

fn floats<const N: usize>(bytes: &[u8], at: usize) -> [f32; N] {
    std::array::from_fn(|i| float(bytes, at + 4 * i))
}

/// The state in a packet; none where it is no such packet. Its numbers may be anything.
pub fn read(bytes: &[u8]) -> Option<Sight> {
    if bytes.len() != STATE_BYTES || !bytes.starts_with(STATE_MARK) {
        return None;
    }
    let word = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
    let estimate = Estimate {
        position: floats(bytes, 16),
        velocity: floats(bytes, 28),
        attitude: floats(bytes, 40),
        body_rates: floats(bytes, 56),
        voltage: float(bytes, 68),
    };
    let time_us = u64::from(word(8)) | u64::from(word(12)) << 32;
    Some(Sight { number: word(4), time_us, estimate, switch: word(72) & 1 == 1 })
}

/// The packet of a state.
#[cfg(feature = "internals")]
pub fn state(sight: &Sight) -> Vec<u8> {
    let e = &sight.estimate;
    let mut out = [STATE_MARK.as_slice(), &sight.number.to_le_bytes(), &sight.time_us.to_le_bytes()].concat();
    let parts: [&[f32]; 5] = [&e.position, &e.velocity, &e.attitude, &e.body_rates, &[e.voltage]];
    parts.concat().iter().for_each(|x| out.extend(x.to_le_bytes()));
    out.extend(u32::from(sight.switch).to_le_bytes());
    out
}

impl Answer {
    /// The packet.
    pub fn bytes(&self) -> [u8; ANSWER_BYTES] {
        let none = Setpoint { body_rates: [0.0; 3], throttle: 0.0, thrust_n: 0.0, thrust_to_weight: 0.0 };
        let s = self.setpoint.unwrap_or(none);
        let [x, y, z] = s.body_rates;
        let mut out =
            [ANSWER_MARK.as_slice(), &(self.phase as u32).to_le_bytes(), &self.time_us.to_le_bytes()].concat();
        out.extend(self.reason.map_or(0, Reason::code).to_le_bytes());
        out.extend(u32::from(self.setpoint.is_some()).to_le_bytes());
        [x, y, z, s.throttle, s.thrust_n, s.thrust_to_weight].iter().for_each(|x| out.extend(x.to_le_bytes()));
        let mut packet = [0; ANSWER_BYTES];
        packet.copy_from_slice(&out);
        packet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_packet_is_none() {
        let estimate = Estimate {
            position: [1.0, 2.0, 3.0],
            velocity: [4.0, 5.0, 6.0],
            attitude: [1.0, 0.0, 0.0, 0.0],
            body_rates: [7.0, 8.0, 9.0],
            voltage: 24.5,
        };
        let sight = Sight { number: 7, time_us: 1 << 40, estimate, switch: true };
        let mut packet = STATE_MARK.to_vec();
        packet.extend(7u32.to_le_bytes());
        packet.extend((1u64 << 40).to_le_bytes());
        for x in [1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0, 1.0, 0.0, 0.0, 0.0, 7.0, 8.0, 9.0, 24.5] {
            packet.extend(x.to_le_bytes());
        }
        packet.extend(1u32.to_le_bytes());
        assert_eq!(read(&packet), Some(sight));
        assert_eq!(read(&packet[..75]), None);
        packet[0] = b'X';
        assert_eq!(read(&packet), None);
        let answer = Answer { phase: Phase::Ended, reason: Some(Reason::Stale), time_us: 5, setpoint: None }.bytes();
        assert_eq!((answer[4], answer[8], answer[20]), (3, 5, 0));
    }
}
