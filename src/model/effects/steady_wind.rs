//! Air that moves over the ground: v_air = v - w.

use super::{Card, Effect, EffectKind, EffectParameter, Quantity, RelativeWind, ResidualChannel, Role};
use crate::base::lane::Real;

pub struct SteadyWind;

const fn speed(name: &'static str) -> EffectParameter {
    EffectParameter { name, unit: "m/s", low: -10.0, high: 10.0, typical: [0.5, 4.0] }
}

impl Effect for SteadyWind {
    const CARD: Card = Card {
        id: "steady_wind",
        name: "steady wind",
        sentence: "the vehicle drifts to one side of the field, whichever way it points",
        kind: EffectKind::Drag,
        parameters: &[speed("wx"), speed("wy")],
        writes: &[Quantity::SpecificForce],
        channels: &[ResidualChannel::Force],
        role: Role::UniformWind,
        signature: "horizontal specific force is constant in the world and turns with the heading in the body",
        rivals: &["rotor_drag", "drag_asymmetry", "accel_bias"],
        manoeuvre: ("the same leg both ways, and circles", &["forward", "backward", "left", "right", "circle"]),
        ..Card::BLANK
    };

    #[inline(always)]
    fn relative_wind<R: Real>(k: &[R], wind: &mut RelativeWind<R>) {
        for (velocity, axis) in wind.velocity.iter_mut().zip(&wind.axes) {
            *velocity = *velocity - axis[0].mul_add(k[0], axis[1] * k[1]);
        }
    }
}
