//! Another mass or density of the air: every specific force is scaled by 1 + share.

use super::{Card, Channel, Effect, Flow, Kind, Parameter};
use crate::base::lane::Real;

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "mass_or_density",
        name: "another mass or air density",
        sentence: "everything pushes and brakes by the same share more or less: the vehicle weighs something else, or the air does",
        kind: Kind::Thrust,
        parameters: &[Parameter { name: "share", unit: "1", low: -0.6, high: 0.6, typical: [0.05, 0.3] }],
        channels: &[Channel::Force],
        signature: "thrust and drag are off by the same share",
        rivals: &["accel_scale"],
        manoeuvre: ("punches and fast passes; weigh the vehicle and read the barometer", &["punch", "forward", "backward"]),
        shown: None,
    };

    #[inline(always)]
    fn flow<R: Real>(k: &[R], flow: &mut Flow<R>) {
        let scale = R::one() + k[0];
        flow.lift = flow.lift * scale;
        flow.force = crate::base::lane::each!(flow.force, |f| f * scale);
    }
}
