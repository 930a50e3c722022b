//! Response that slows with the battery, by 1 + k (V_full - V) on the rate axes: lag, second order (T2) and limit of
//! the angular acceleration alike. Motors turn a vehicle by the square of the voltage; the gain of its rate loop and
//! its largest angular acceleration fall by as much.

use super::{Actuator, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct ResponseVoltage;

impl Effect for ResponseVoltage {
    const CARD: Card = Card {
        id: "response_voltage",
        name: "response slows with voltage",
        sentence: "the vehicle feels lazy on all axes late in the pack",
        kind: EffectKind::Timing,
        parameters: &[EffectParameter { name: "k", unit: "1/V", low: 0.0, high: 0.5, typical: [0.05, 0.2] }],
        writes: &[Quantity::RateCommand],
        channels: &[ResidualChannel::Rate],
        signature: "the gyro lags the simulated rate more the lower the voltage is",
        rivals: &["clock_skew"],
        manoeuvre: (
            "the same steps with a full and with an empty battery",
            &["rate-steps", "roll-doublets", "pitch-doublets"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn actuator<R: Real>(k: &[R], actuator: &mut Actuator<R>) {
        actuator.slower = k[0].mul_add(actuator.missing_v, R::one()).max(R::of(0.2));
    }
}
