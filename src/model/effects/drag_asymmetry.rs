//! Drag that differs between forward and backward: f_x -= k v_x^2.

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "drag_asymmetry",
        name: "different drag forward and backward",
        sentence: "at the same lean the vehicle is faster in one direction than in the other",
        kind: Kind::Drag,
        parameters: &[Parameter { name: "k", unit: "1/m", low: -0.02, high: 0.02, typical: [0.001, 0.008] }],
        channels: &[Channel::Force],
        signature: "forward specific force has a part that is the same for flight forward and backward",
        rivals: &["body_lift", "steady_wind"],
        manoeuvre: ("fast passes forward and backward", &["forward", "backward"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        let x = flow.velocity[0];
        flow.force[0] = flow.force[0] - k[0] * x * x;
    }
}
