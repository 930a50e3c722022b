//! Room that a mixer makes for turns: the throttle s stays between k e and 1 - k e, and so near the middle in sharp
//! turns, with e the sum over the axes of |command - response|, rad/s.
//!
//! Motors can be neither slower than stopped nor faster than full. A flight controller that keeps its turns all the
//! same (Betaflight calls that airmode) moves all of them together: more thrust than asked for near closed throttle,
//! less near full. The gain k is that of the controller, which is much the same for every axis. It comes before what
//! moves the command out of -1..1, which a size of 0 would else cut off.

use super::{Card, ControllerPart, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel, ThrustInput};
use crate::base::lane::Real;

pub struct MixerRoom;

impl Effect for MixerRoom {
    const CARD: Card = Card {
        id: "mixer_room",
        name: "room that the mixer makes for turns",
        sentence: "jerked around at closed throttle the vehicle rises, at full throttle it sinks",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "k", unit: "s/rad", low: 0.0, high: 0.5, typical: [0.02, 0.1] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::RateError],
        channels: &[ResidualChannel::Force],
        controller: Some(ControllerPart::Room),
        signature: "vertical specific force is that of half throttle while the rates are behind their commands",
        rivals: &["mixer_thrust_loss", "rate_thrust_coupling"],
        manoeuvre: ("sharp turns at closed and at full throttle", &["rate-steps", "punch-turns"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn thrust_input<R: Real>(k: &[R], input: &mut ThrustInput<R>) {
        input.command = with_room(input.command, k[0], input.behind);
    }
}

/// The command (-1..1) with room made for rates that are so far behind, rad/s; `k` in s/rad.
#[inline(always)]
pub fn with_room<R: Real>(command: R, k: R, behind: R) -> R {
    // Half the throttle is all the room that can be made.
    let least = (k * behind * R::of(2.0)).min(R::one());
    command.clamp(least - R::one(), R::one() - least)
}
