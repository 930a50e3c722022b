//! Rotors that slow down with another lag than they speed up with: tau of falling thrust is that of rising thrust plus
//! a difference. Motors that only brake by drag fall later; thrust by the square of a speed that lags rises later.

use super::{Actuator, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct ThrustAsymmetricLag;

impl Effect for ThrustAsymmetricLag {
    const CARD: Card = Card {
        id: "thrust_asymmetric_lag",
        name: "spin-down and spin-up of different lag",
        sentence: "thrust dies away after a throttle cut with another lag than it builds up with after a punch",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter {
            name: "difference",
            unit: "s",
            low: -0.02,
            high: 0.08,
            typical: [0.004, 0.025],
        }],
        writes: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Force],
        signature: "vertical specific force lags otherwise after throttle cuts than after punches",
        rivals: &["thrust_delay", "throttle_offset"],
        manoeuvre: ("throttle steps up and down of the same size, and cuts", &["throttle-steps", "punch", "chop"]),
        shown: Some(|k, [.., tau]| vec![("tau_up", tau, "s"), ("tau_down", tau + k[0], "s")]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn actuator<R: Real>(k: &[R], actuator: &mut Actuator<R>) {
        actuator.tau_down = (actuator.tau_down + k[0]).max(R::of(0.0005));
    }
}
