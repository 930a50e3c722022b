//! The vehicle as it was simulated, to the digit: whoever writes down these steps flies the same lap.

use crate::model::constants::CONTROL_S;
use crate::model::dynamics::{Factors, Parameters};
use crate::model::vehicle::Vehicle;
use serde_json::{Value, json};

/// The paper that docs/references.md names.
const PAPER: &str = "Rapid Sim-to-Real Reinforcement Learning for Autonomous Drone Racing";

pub fn model(vehicle: &Vehicle) -> Value {
    let p = Parameters::new(vehicle, &Factors::NOMINAL, CONTROL_S);
    let effects: Vec<_> = vehicle.effects.sizes.keys().collect();
    json!({
        "paper": PAPER,
        "equations": [
            equation("response", "du/dt = (a - u) / time_constant; body rates w = u * max_rate", "Eq. 6"),
            equation("thrust", "along body z: c[0] + c[1] u + c[2] u^2 + c[3] u^3 + c[4] V + c[5] u V", "Eq. 7"),
            equation("motion", "dp/dt = v; dv/dt = (thrust + drag) / mass - gravity; dR/dt = R [w]x", "Eq. 8"),
            equation(
                "drag",
                "against v, with the projected area of an ellipsoid: |(kx vx, ky vy, kz vz)| |v| mass, v in the body \
                 frame",
                "Eq. 9",
            ),
            equation("battery", "dV/dt = voltage_rate", "Eq. 5"),
        ],
        "step": STEP,
        "parameters": {
            "dt_s": p.dt, "share": p.alpha, "mean_share": p.mean_alpha, "max_rate_rad_s": p.max_rate,
            "thrust_m_s2": p.thrust, "drag_1_m": p.drag, "gravity_m_s2": p.gravity, "voltage_rate_v_s": p.voltage_rate,
        },
        "complete": effects.is_empty(),
        "effects": effects,
        "effects_note": "where there are effects beyond these equations, training had them and this description of the \
                         motion lacks them; frames, observation, action and filter are the same",
    })
}

fn equation(name: &str, equation: &str, reference: &str) -> Value {
    json!({ "name": name, "equation": equation, "reference": reference })
}

/// One step of `dynamics::step`, line by line.
const STEP: [&str; 9] = [
    "m[k] = u[k] + mean_share[k] (a[k] - u[k]) is the mean command of the step, for k = 0..3; then u[k] += share[k] \
     (a[k] - u[k])",
    "h = dt; q_half is the rotation by the vector max_rate * m[0..2] * h / 2 in the body frame",
    "q_middle = q * q_half; the new q = q_middle * q_half, normalised; B has the body's axes of q_middle as rows",
    "V_middle = V + voltage_rate h / 2; T = thrust with m[3] and V_middle, over the mass",
    "free = T * (body z of q_middle) - (0, 0, gravity); early = v + free h / 2",
    "k = |drag * (B early)|, entry by entry; k = k - h k^2",
    "acceleration = free - k * early; the new v = v + acceleration h",
    "the new p = p + (v + new v) h / 2",
    "the new V = V_middle + voltage_rate h / 2",
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::vehicle::Vehicle;

    #[test]
    fn effects_are_named_and_make_the_model_incomplete() {
        let mut vehicle = Vehicle::load("seed_class").unwrap();
        assert_eq!(model(&vehicle)["complete"], true);
        let card = &crate::model::effects::MODEL[0];
        let sizes = card.parameters.iter().map(|p| (p.name.to_string(), p.low)).collect();
        vehicle.effects.sizes.insert(card.id.into(), sizes);
        let told = model(&vehicle);
        assert_eq!((told["complete"].as_bool(), told["effects"][0].as_str()), (Some(false), Some(card.id)));
    }
}
