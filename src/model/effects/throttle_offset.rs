//! A throttle that is off by a constant: s becomes s + u0.

use super::{Card, Channel, Effect, Kind, Parameter, Supply};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "throttle_offset",
        name: "throttle offset",
        sentence: "the vehicle lifts off at a lower or higher stick than it should, and the stick is off by the same everywhere",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "u0", unit: "1", low: -0.15, high: 0.15, typical: [0.01, 0.05] }],
        channels: &[Channel::Force],
        signature: "vertical specific force is off by the slope of the thrust curve",
        rivals: &["thrust_asymmetric_lag", "vibration_rectification"],
        manoeuvre: ("slow throttle ramps from none to full", &["ramp-up", "ramp-down"]),
        shown: None,
    };

    #[inline(always)]
    fn supply<R: Real>(k: &[R], supply: &mut Supply<R>) {
        supply.command = supply.command + k[0] + k[0];
    }
}
