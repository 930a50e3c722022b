//! Response that slows with the battery: tau becomes tau (1 + k (V_full - V)) on the rate axes.

use super::{Card, Channel, Effect, Kind, Lag, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "response_voltage",
        name: "response slows with voltage",
        sentence: "the vehicle feels lazy on all axes late in the pack",
        kind: Kind::Timing,
        parameters: &[Parameter { name: "k", unit: "1/V", low: 0.0, high: 0.5, typical: [0.05, 0.2] }],
        channels: &[Channel::Rate],
        signature: "the gyro lags the simulated rate more the lower the voltage is",
        rivals: &["clock_skew"],
        manoeuvre: ("the same steps with a full and with an empty battery", &["rate-steps", "roll-doublets", "pitch-doublets"]),
        shown: None,
    };

    #[inline(always)]
    fn lag<R: Real>(k: &[R], lag: &mut Lag<R>) {
        let slower = k[0].mul_add(lag.missing_v, R::one()).max(R::of(0.2));
        let [roll, pitch, yaw, thrust] = lag.tau;
        lag.tau = [roll * slower, pitch * slower, yaw * slower, thrust];
    }
}
