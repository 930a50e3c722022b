//! Rolling pitches, and pitching rolls: w_x += k_xy w_y, w_y += k_yx w_x.

use super::{Card, Channel, Effect, Kind, Parameter, Spin};
use crate::base::lane::Real;

pub struct It;

const fn share(name: &'static str) -> Parameter {
    Parameter { name, unit: "1", low: -0.3, high: 0.3, typical: [0.01, 0.1] }
}

impl Effect for It {
    const CARD: Card = Card {
        id: "rate_cross_coupling",
        name: "coupling of roll and pitch",
        sentence: "a pure roll also pitches a little, or a pure pitch rolls",
        kind: Kind::Timing,
        parameters: &[share("kxy"), share("kyx")],
        channels: &[Channel::Rate],
        signature: "the off-axis rate follows the other axis in proportion, in gyro and attitude alike",
        rivals: &["imu_misalignment", "gyroscopic_coupling"],
        manoeuvre: ("doublets and flips on one axis at a time", &["roll-doublets", "pitch-doublets", "roll-flip", "pitch-flip"]),
        shown: None,
    };

    #[inline(always)]
    fn spin<R: Real>(k: &[R], spin: &mut Spin<R>) {
        let [x, y, z] = spin.rates;
        spin.rates = [k[0].mul_add(y, x), k[1].mul_add(x, y), z];
    }
}
