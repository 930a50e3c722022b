//! A motor or propeller that gives less than the others: w += b s.

use super::{Card, Channel, Effect, Kind, Parameter, Spin};
use crate::base::lane::Real;

pub struct It;

const fn rate(name: &'static str) -> Parameter {
    Parameter { name, unit: "rad/s", low: -1.5, high: 1.5, typical: [0.05, 0.6] }
}

impl Effect for It {
    const CARD: Card = Card {
        id: "weak_motor",
        name: "weak motor",
        sentence: "the vehicle leans and turns by itself, the more the higher the throttle",
        kind: Kind::Timing,
        parameters: &[rate("bx"), rate("by"), rate("bz")],
        channels: &[Channel::Rate],
        signature: "the mean rate without command grows in proportion to the throttle",
        rivals: &["gyro_bias"],
        manoeuvre: ("slow throttle sweeps with the other sticks centred", &["ramp-up", "ramp-down", "punch"]),
        shown: Some(|k, _| {
            let b = (k[0].abs() + k[1].abs() + k[2].abs()) / 3.0;
            vec![("bx", k[0], "rad/s"), ("by", k[1], "rad/s"), ("bz", k[2], "rad/s"), ("b", b, "rad/s")]
        }),
    };

    #[inline(always)]
    fn spin<R: Real>(k: &[R], spin: &mut Spin<R>) {
        for (rate, b) in spin.rates.iter_mut().zip(k) {
            *rate = b.mul_add(spin.throttle, *rate);
        }
    }
}
