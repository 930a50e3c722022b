//! MSP: sticks for a flight controller that flies rates, as Betaflight and iNAV do; its battery and channels back.

pub mod frame;

use super::answer::Answer;
use super::heard::Heard;
use super::protocol::Protocol;
use super::switch::Switch;
use frame::{Replies, Reply, request};

const SET_RAW_RC: u8 = 200;
const RC: u8 = 105;
const BATTERY_STATE: u8 = 130;
/// Channels that are sent: roll, pitch, throttle, yaw (the order AETR), and the switches.
const CHANNELS: usize = 16;
/// Ends and middle of a channel, us.
const LOW: u16 = 1000;
const MIDDLE: f32 = 1500.0;
const HIGH: u16 = 2000;
/// Half the way of a stick, us.
const HALF: f32 = 500.0;
/// Throttle below which Betaflight sees none (`min_check`), us: its range begins there.
const NO_THROTTLE: f32 = 1050.0;
/// Every so many commands one is a question instead of sticks, and every so many questions one for the battery.
const ASK: u64 = 10;
const ASK_BATTERY: u64 = 5;
/// Commands that may wait to be answered. Betaflight reads one in 10 ms: what is sent faster piles up, and sticks come
/// ever later.
const AHEAD: u32 = 2;
/// Time without an answer after which none is waited for, s: the line may lead one way only.
const SILENCE_S: f64 = 0.2;

/// Sticks of a flight controller.
#[derive(Debug)]
pub struct Msp {
    replies: Replies,
    switch: Option<Switch>,
    /// Rates that full sticks ask for, rad/s.
    full_rate: [f32; 3],
    /// The channel that arms, from 1; none where the pilot does.
    arm: Option<usize>,
    /// Commands sent, those of them that wait to be answered, and when the last answer came, s.
    sent: u64,
    waiting: u32,
    answered_s: f64,
}

impl Msp {
    /// Before the first period. `switch` is what to take for the dead man's, if it is to come over this link.
    pub fn new(switch: Option<Switch>, full_rate: [f64; 3], arm: Option<usize>) -> Self {
        Self {
            replies: Replies::default(),
            switch,
            full_rate: full_rate.map(|x| x as f32),
            arm,
            sent: 0,
            waiting: 0,
            answered_s: f64::NEG_INFINITY,
        }
    }

    fn reply(&self, reply: &Reply) -> Option<Heard> {
        let word = |at: usize| Some(u16::from_le_bytes([*reply.payload.get(at)?, *reply.payload.get(at + 1)?]));
        match reply.command {
            RC if !reply.refused => {
                let channels: Vec<u16> = (0..reply.payload.len() / 2).filter_map(|i| word(2 * i)).collect();
                self.switch?.of_channels(&channels)
            }
            // No cells: no battery is measured.
            BATTERY_STATE if reply.payload.first().is_some_and(|&cells| cells > 0) => {
                word(9).map(|hundredths| Heard::Voltage(f32::from(hundredths) / 100.0))
            }
            _ => None,
        }
    }

    /// Where the channels have to stand, us.
    fn channels(&self, answer: &Answer) -> [u16; CHANNELS] {
        let mut out = [LOW; CHANNELS];
        let (rates, throttle) = answer.setpoint.map_or(([0.0; 3], None), |s| (s.body_rates, Some(s.throttle)));
        let stick = |i: usize, sign: f32| {
            let way = (sign * rates[i] / self.full_rate[i]).clamp(-1.0, 1.0);
            (MIDDLE + HALF * way).round() as u16
        };
        // Sticks: right, forward, right. Body rates front-left-up: right side down, nose down, nose left.
        (out[0], out[1], out[3]) = (stick(0, 1.0), stick(1, 1.0), stick(2, -1.0));
        let way = f32::from(HIGH) - NO_THROTTLE;
        out[2] = throttle.map_or(LOW, |t| (NO_THROTTLE + way * t.clamp(0.0, 1.0)).round() as u16);
        if let Some(arm) = self.arm.filter(|_| answer.armed) {
            out[arm - 1] = HIGH;
        }
        out
    }
}

impl Protocol for Msp {
    fn hear(&mut self, bytes: &[u8], now_s: f64) -> Vec<Heard> {
        let replies = self.replies.hear(bytes);
        if !replies.is_empty() {
            self.answered_s = now_s;
            self.waiting = self.waiting.saturating_sub(replies.len() as u32);
        }
        replies.iter().filter_map(|reply| self.reply(reply)).collect()
    }

    /// Sticks in every phase: the flight controller keeps the last it was sent, so that a flight has to be followed by
    /// middle sticks and no throttle.
    fn say(&mut self, answer: &Answer, now_s: f64) -> Vec<u8> {
        if now_s - self.answered_s > SILENCE_S {
            self.waiting = 0;
        }
        if self.waiting >= AHEAD {
            return Vec::new();
        }
        (self.sent, self.waiting) = (self.sent + 1, self.waiting + 1);
        match (self.sent % ASK, self.sent / ASK % ASK_BATTERY) {
            (0, 1..) if self.switch.is_some() => request(RC, &[]),
            (0, _) => request(BATTERY_STATE, &[]),
            _ => {
                let sticks: Vec<u8> = self.channels(answer).iter().flat_map(|us| us.to_le_bytes()).collect();
                request(SET_RAW_RC, &sticks)
            }
        }
    }
}
