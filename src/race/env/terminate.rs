//! When an episode ends (paper section 4.3).
//!
//! Termination ends the future: nothing is gained after it. The horizon only truncates: the flight could have gone on,
//! and the learner is told so.

use super::{Block, Race};
use crate::base::lane::{Lane, Mask};

/// Causes of termination, in the order in which they are looked at; the first that holds is logged.
pub const CAUSES: [&str; 6] = ["non_finite", "missed_gate", "left_volume", "altitude", "battery", "gate_timeout"];

#[inline(always)]
fn outside<L: Lane>(x: L, low: f64, high: f64) -> L::Mask {
    x.lt(L::of(low)) | L::of(high).lt(x)
}

/// The causes' lanes as bits, each lane at most once.
#[inline(always)]
pub fn causes<L: Lane>(race: &Race, block: &Block<L>, missed: L::Mask, timed_out: L::Mask) -> [u32; CAUSES.len()] {
    let state = &block.craft.state;
    let [x, y, z] = state.position;
    let [low, high] = race.volume;
    // A number that is not finite makes this sum so.
    let [vx, vy, vz] = state.velocity;
    let [qw, qx, qy, qz] = state.attitude;
    let sum = (x + y + z) + (vx + vy + vz) + (qw + qx + qy + qz);
    let all = [
        (!sum.is_finite()).bits(),
        missed.bits(),
        (outside(x, low[0], high[0]) | outside(y, low[1], high[1])).bits(),
        outside(z, low[2], high[2]).bits(),
        state.voltage.lt(L::of(race.empty_v)).bits(),
        timed_out.bits(),
    ];
    let mut seen = 0;
    all.map(|lanes| {
        let new = lanes & !seen & 0xffff;
        seen |= lanes;
        new
    })
}
