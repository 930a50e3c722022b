//! Open-circuit voltage as an S over the charge instead of a line: V += k P3(2 c - 1), P3 the third
//! Legendre polynomial.

use super::{BatteryLoad, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct OcvCurve;

impl Effect for OcvCurve {
    const CARD: Card = Card {
        id: "ocv_curve",
        name: "S-shaped discharge curve",
        sentence: "the voltage falls fast at first, then hardly, then fast again at the end of the pack",
        kind: EffectKind::Battery,
        parameters: &[EffectParameter { name: "k", unit: "V", low: -2.0, high: 2.0, typical: [0.2, 0.8] }],
        writes: &[Quantity::Voltage],
        channels: &[ResidualChannel::Voltage],
        signature: "the voltage without load leaves the line as a cubic over the pack",
        rivals: &["voltage_sag", "voltage_relaxation"],
        manoeuvre: ("one whole pack from full to empty", &["circle", "forward", "backward"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn battery_load<R: Real>(k: &[R], battery: &mut BatteryLoad<R>) {
        let x = (battery.charge + battery.charge).clamp(R::zero(), R::of(2.0)) - R::one();
        let cubic = x * (x * x).mul_add(R::of(2.5), R::of(-1.5));
        battery.drop = battery.drop - k[0] * cubic;
    }
}
