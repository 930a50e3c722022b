//! Voltage lost to slow polarisation: V1' = (v s^2 - V1) / tau.

use super::{BatteryLoad, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct VoltageRelaxation;

impl Effect for VoltageRelaxation {
    const CARD: Card = Card {
        id: "voltage_relaxation",
        name: "slow recovery of the voltage",
        sentence: "after a long pull the voltage takes seconds to come back",
        kind: EffectKind::Battery,
        parameters: &[
            EffectParameter { name: "v_full", unit: "V", low: 0.0, high: 4.0, typical: [0.2, 1.5] },
            EffectParameter { name: "tau", unit: "s", low: 0.0, high: 90.0, typical: [1.0, 30.0] },
        ],
        shape: Some(1),
        writes: &[Quantity::Voltage],
        reads: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Voltage],
        signature: "the voltage follows the load of the past seconds and recovers slowly at rest",
        rivals: &["voltage_sag", "ocv_curve"],
        manoeuvre: ("a long pull, then rest", &["punch", "chop", "climb", "descent"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn battery_load<R: Real>(k: &[R], battery: &mut BatteryLoad<R>) {
        let follow = R::one() - (-(battery.dt / k[1].max(R::of(0.05)))).exp();
        battery.polarisation = follow.mul_add(k[0] * battery.load - battery.polarisation, battery.polarisation);
        battery.drop = battery.drop + battery.polarisation;
    }
}
