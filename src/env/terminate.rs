//! When an episode ends (paper section 4.3).
//!
//! Termination ends the future: nothing is gained after it. The horizon only truncates: the flight could have gone on,
//! and the learner is told so.

use super::{Block, Race};
use crate::lane::{Lane, Mask};

/// Causes of termination, in the order in which they are looked at; the first that holds is logged.
pub const CAUSES: [&str; 6] = ["non_finite", "missed_gate", "left_volume", "altitude", "battery", "gate_timeout"];

/// The causes' lanes as bits, each lane at most once.
#[inline(always)]
pub fn causes<L: Lane>(race: &Race, block: &Block<L>, missed: L::Mask, timed_out: L::Mask) -> [u32; CAUSES.len()] {
    let [x, y, z] = block.state.position;
    let [low, high] = race.volume;
    let outside = |v: L, i: usize| v.lt(L::of(low[i])) | L::of(high[i]).lt(v);
    // A number that is not finite makes this sum so.
    let sum = block.state.velocity.iter().chain(&block.state.attitude).fold(x + y + z, |s, &v| s + v);
    let all = [
        (!sum.is_finite()).bits(),
        missed.bits(),
        (outside(x, 0) | outside(y, 1)).bits(),
        outside(z, 2).bits(),
        block.state.voltage.lt(L::of(race.empty_v)).bits(),
        timed_out.bits(),
    ];
    let mut seen = 0;
    all.map(|lanes| {
        let new = lanes & !seen & 0xffff;
        seen |= lanes;
        new
    })
}
