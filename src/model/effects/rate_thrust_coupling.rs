//! Thrust lost in turns: f_T -= k (w_x^2 + w_y^2).

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "rate_thrust_coupling",
        name: "thrust lost to body rates",
        sentence: "the vehicle drops a little in fast rolls and flips, the more the faster they are",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "k", unit: "m", low: 0.0, high: 0.05, typical: [0.002, 0.02] }],
        channels: &[Channel::Force],
        signature: "vertical specific force alone falls with the square of roll and pitch rate",
        rivals: &["mixer_thrust_loss", "imu_lever_arm"],
        manoeuvre: ("flips at steady rates and at one throttle", &["roll-flip", "pitch-flip"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        let [x, y, _] = flow.rates;
        flow.lift = flow.lift - k[0] * x.mul_add(x, y * y);
    }
}
