//! Pure delay of the thrust command: u(t) becomes u(t - d).

use super::{Card, Channel, Effect, Kind, Late, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "thrust_delay",
        name: "thrust command delay",
        sentence: "the motors answer the throttle later than a lag alone explains",
        kind: Kind::Timing,
        parameters: &[Parameter { name: "delay", unit: "s", low: 0.0, high: 0.12, typical: [0.002, 0.03] }],
        channels: &[Channel::Force],
        signature: "vertical specific force lags the simulated thrust by the same time at every frequency",
        rivals: &["thrust_asymmetric_lag"],
        manoeuvre: ("throttle steps up and down, and punches", &["throttle-steps", "punch", "chop"]),
        shown: None,
    };

    #[inline(always)]
    fn late<R: Real>(k: &[R], late: &mut Late<R>) {
        late.thrust = late.thrust + k[0];
    }
}
