//! Open-circuit voltage as a curve over the charge c instead of a line: V += k P3(2 c - 1) + bend P2(2 c - 1), with the
//! third and second Legendre polynomials.

use super::{BatteryLoad, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct OcvCurve;

impl Effect for OcvCurve {
    const CARD: Card = Card {
        id: "ocv_curve",
        name: "curved discharge",
        sentence: "the voltage does not fall evenly: fast at first, or at the end of the pack, or at both",
        kind: EffectKind::Battery,
        parameters: &[
            EffectParameter { name: "k", unit: "V", low: -2.0, high: 2.0, typical: [0.2, 0.8] },
            EffectParameter { name: "bend", unit: "V", low: -2.0, high: 2.0, typical: [0.1, 0.4] },
        ],
        writes: &[Quantity::Voltage],
        channels: &[ResidualChannel::Voltage],
        signature: "the voltage without load leaves the line as a parabola or a cubic over the pack",
        rivals: &["voltage_sag", "voltage_relaxation"],
        manoeuvre: ("one whole pack from full to empty", &["circle", "forward", "backward"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn battery_load<R: Real>(k: &[R], battery: &mut BatteryLoad<R>) {
        let x = (battery.charge + battery.charge).clamp(R::zero(), R::of(2.0)) - R::one();
        let cubic = x * (x * x).mul_add(R::of(2.5), R::of(-1.5));
        let square = (x * x).mul_add(R::of(1.5), R::of(-0.5));
        battery.drop = battery.drop - k[0] * cubic - k[1] * square;
    }
}
