//! Turning about two axes pushes the third: w_x' += k w_y w_z, w_y' -= k w_z w_x, less what the rate loop holds.

use super::{Asked, Card, Channel, Effect, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "gyroscopic_coupling",
        name: "gyroscopic coupling",
        sentence: "a turn about two axes at once drags in the third",
        kind: Kind::Timing,
        parameters: &[Parameter { name: "k", unit: "1", low: -1.0, high: 1.0, typical: [0.01, 0.05] }],
        channels: &[Channel::Rate],
        signature: "the rate of one axis follows the product of the two others",
        rivals: &["rate_cross_coupling"],
        manoeuvre: ("yaw spins with roll and pitch at the same time", &["rate-steps", "yaw-spin", "circle"]),
        shown: None,
    };

    #[inline(always)]
    fn ask<R: Real>(k: &[R], asked: &mut Asked<R>) {
        let [x, y, z] = asked.rates;
        let (tau, max) = (asked.tau, asked.max_rate);
        asked.command[0] = asked.command[0] + k[0] * y * z * tau[0] / max[0];
        asked.command[1] = asked.command[1] - k[0] * z * x * tau[1] / max[1];
    }
}
