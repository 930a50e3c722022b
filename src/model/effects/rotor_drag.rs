//! Drag of the turning rotors: f_xy -= k s v_xy (blade flapping and induced drag).

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "rotor_drag",
        name: "rotor drag",
        sentence: "the vehicle slows down even at low speed, more with more throttle",
        kind: Kind::Drag,
        parameters: &[Parameter { name: "k", unit: "1/s", low: 0.0, high: 1.5, typical: [0.05, 0.5] }],
        channels: &[Channel::Force],
        signature: "horizontal specific force opposes the speed in proportion, times the throttle",
        rivals: &["steady_wind"],
        manoeuvre: ("passes from 2 to 20 m/s in every direction", &["forward", "backward", "left", "right"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        let damping = k[0] * flow.throttle;
        for i in 0..2 {
            flow.force[i] = flow.force[i] - damping * flow.velocity[i];
        }
    }
}
