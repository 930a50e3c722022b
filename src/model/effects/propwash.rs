//! Thrust lost in the own wake: f_T is scaled by 1 - k g(-v_z / v_i), most where the descent is 1.2 times the
//! induced velocity v_i.

use super::{AerodynamicForces, Card, Effect, EffectKind, EffectParameter, Quantity, ResidualChannel};
use crate::base::lane::Real;

pub struct Propwash;

/// Induced velocity over the root of thrust over mass, of a 5-inch quadrotor.
const INDUCED: f64 = 1.6;
/// Descent over induced velocity: where the loss is largest, how wide it is, and where it is at its full height.
const WORST: f64 = 1.2;
const WIDTH: f64 = 0.5;
const ONSET: f64 = 0.6;

impl Effect for Propwash {
    const CARD: Card = Card {
        id: "propwash",
        name: "propwash",
        sentence: "sinking into its own wake the vehicle drops faster and shakes",
        kind: EffectKind::Thrust,
        parameters: &[EffectParameter { name: "k", unit: "1", low: 0.0, high: 0.8, typical: [0.08, 0.33] }],
        writes: &[Quantity::SpecificForce],
        reads: &[Quantity::Velocity],
        channels: &[ResidualChannel::Force],
        nonlinear: true,
        signature: "vertical specific force drops, and its scatter grows, in descents near the induced velocity only",
        rivals: &["axial_inflow"],
        manoeuvre: ("vertical and slanted descents at several speeds", &["descent", "dive", "chop"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn aerodynamic_forces<R: Real>(k: &[R], forces: &mut AerodynamicForces<R>) {
        let x = -forces.velocity[2] / (forces.specific_thrust.max(R::of(0.1)).sqrt() * R::of(INDUCED));
        let off = (x - R::of(WORST)) * R::of(1.0 / WIDTH);
        let within = (x * R::of(1.0 / ONSET)).clamp(R::zero(), R::one());
        forces.specific_thrust = forces.specific_thrust * (R::one() - k[0] * (-(off * off)).exp() * within);
    }
}
