//! Voltage lost to the battery's inner resistance at once: V = V_oc - v s^2, v at full throttle.

use super::{BatteryLoad, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct VoltageSag;

impl Effect for VoltageSag {
    const CARD: Card = Card {
        id: "voltage_sag",
        name: "voltage sag",
        sentence: "the voltage drops the moment the throttle opens and is back when it closes",
        kind: EffectKind::Battery,
        parameters: &[EffectParameter { name: "v_full", unit: "V", low: 0.0, high: 8.0, typical: [0.8, 3.0] }],
        writes: &[Quantity::Voltage],
        reads: &[Quantity::ThrustCommand],
        channels: &[ResidualChannel::Voltage],
        signature: "the voltage falls with the square of the throttle, at once",
        rivals: &["voltage_relaxation", "ocv_curve"],
        manoeuvre: ("punches with rest between them", &["punch", "chop", "throttle-steps"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn battery_load<R: Real>(k: &[R], battery: &mut BatteryLoad<R>) {
        battery.drop = k[0].mul_add(battery.load, battery.drop);
    }
}
