//! Firmware that scales the motors with the voltage: a share of its change never reaches the thrust.

use super::{Card, Channel, Effect, Kind, Parameter, Supply};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "voltage_compensation",
        name: "voltage compensation",
        sentence: "the same stick gives the same thrust late in the pack, because the flight controller makes up for the voltage",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "share", unit: "1", low: 0.0, high: 1.0, typical: [0.2, 1.0] }],
        channels: &[Channel::Force],
        signature: "the thrust does not fall with the voltage as the thrust curve says",
        rivals: &["thrust_fade"],
        manoeuvre: ("the same throttle with a full and with an empty battery, in punches and at rest", &["throttle-steps", "punch", "climb"]),
        shown: None,
    };

    #[inline(always)]
    fn supply<R: Real>(k: &[R], supply: &mut Supply<R>) {
        let rest = R::one() - k[0];
        supply.voltage = rest.mul_add(supply.voltage - supply.middle_v, supply.middle_v);
    }
}
