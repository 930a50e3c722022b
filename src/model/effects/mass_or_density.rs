//! Another mass or density of the wind: every specific force is scaled by 1 + share.

use super::{AerodynamicForces, Card, CompactNumber, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct MassOrDensity;

impl Effect for MassOrDensity {
    const CARD: Card = Card {
        id: "mass_or_density",
        name: "another mass or air density",
        sentence: "everything pushes and brakes by the same share more or less: the vehicle weighs something else, \
            or the air does",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "share", unit: "1", low: -0.6, high: 0.6, typical: [0.05, 0.3] }],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        absorbed_by: &[CompactNumber::Thrust, CompactNumber::Drag],
        signature: "thrust and drag are off by the same share",
        rivals: &["accel_scale"],
        manoeuvre: (
            "punches and fast passes; weigh the vehicle and read the barometer",
            &["punch", "forward", "backward"],
        ),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let scale = R::one() + k[0];
        forces.specific_thrust = forces.specific_thrust * scale;
        forces.force = crate::base::lane::each!(forces.force, |f| f * scale);
    }
}
