//! What stands in a policy's file for whoever flies it without racer. `docs/policy-file.md` explains it, and
//! `docs/policy.schema.json` is its form.
//!
//! Letters: p, v position and velocity in the world; R the rotation of the body into the world, its columns the body's
//! axes; w body rates; G the target gate's axes as rows, c its centre, c1 and c2 those of the two gates behind it; u
//! the filtered commands, a the action, V the voltage.

mod course;
mod model;

use super::self_test::{self, FlownStep, SETPOINT_TOLERANCE, SelfTestRows, TOLERANCE};
use super::{About, seen};
use crate::learn::nn::{HIDDEN, Network};
use crate::learn::policy::ACTIONS;
use crate::model::constants::CONTROL_S;
use crate::race::env::observe::{Group, OBSERVATIONS, layout};
use crate::race::onboard::{AT_START, Surroundings};
use serde_json::{Value, json};

/// What [`flying`] is made of beside the policy itself.
pub struct Shown<'a> {
    pub network: &'a Network<f32>,
    pub about: &'a About,
    /// Least and greatest of every entry of the observation.
    pub range: [[f32; OBSERVATIONS]; 2],
    /// The steps of the self-test, and the lap of the flight that they are from, s.
    pub steps: &'a [FlownStep],
    pub lap_s: Option<f64>,
}

/// Rate at which a policy is to be asked, Hz.
pub fn control_rate_hz() -> f64 {
    (1.0 / CONTROL_S).round()
}

/// What the actions are called.
pub const ACTION_NAMES: [&str; ACTIONS] = ["roll rate", "pitch rate", "yaw rate", "collective thrust"];

/// Everything that flying the policy takes, but for the numbers of the network.
pub fn flying(shown: &Shown) -> Value {
    let About { track, vehicle, env, .. } = shown.about;
    let around = Surroundings::of(track, vehicle);
    json!({
        "control_rate_hz": control_rate_hz(),
        "frames": frames(),
        "network": network(shown.network),
        "observation": observation(&layout(&vehicle.battery), &shown.range),
        "observation_range": range_note(),
        "action": actions(&around),
        "setpoint": setpoint(&around, vehicle.mass_kg),
        "filter": filter(&around, vehicle.time_constants()),
        "start": course::start(track, vehicle),
        "gates": course::gates(track, env),
        "limits": course::limits(track, vehicle, env),
        "model": model::model(vehicle),
        "self_test": self_test(shown),
    })
}

fn frames() -> Value {
    json!({
        "world": "ENU: x east, y north, z up; m",
        "body": "FLU: x forward, y left, z up; a positive roll rate lowers the right side, a positive pitch rate the \
                 nose, a positive yaw rate turns left",
        "gate": "x along the direction of crossing, y left, z up; origin at the gate's centre. G has these axes, in \
                 the world, as its rows: G d turns a world vector d into the gate frame",
        "attitude": "unit quaternion w, x, y, z from body to world; R = [[1-2(yy+zz), 2(xy-wz), 2(xz+wy)], \
                     [2(xy+wz), 1-2(xx+zz), 2(yz-wx)], [2(xz-wy), 2(yz+wx), 1-2(xx+yy)]]; R b turns a body vector b \
                     into the world",
        "letters": "p position and v velocity in the world; w body rates about the body's axes; G and c axes and \
                    centre of the target gate; c1, c2 centres of the next gate and of the one after it; V voltage at \
                    the battery's terminals; u filtered commands; a action",
    })
}

fn network(network: &Network<f32>) -> Value {
    let sizes = [network.inputs(), HIDDEN, HIDDEN, ACTIONS];
    let layer = |i: usize| {
        json!({
            "weight": format!("actor.{i}.weight"), "bias": format!("actor.{i}.bias"),
            "inputs": sizes[i], "outputs": sizes[i + 1], "activation": "tanh",
        })
    };
    json!({
        "layers": [layer(0), layer(1), layer(2)],
        "layout": "weights are [inputs][outputs], row after row, little-endian float32: y = tanh(x W + b)",
        "others": "critic.* and log_std belong to training; flying needs none of them",
    })
}

fn observation(groups: &[Group], range: &[[f32; OBSERVATIONS]; 2]) -> Value {
    let mut at = 0;
    let described = groups.iter().map(|group| {
        let mut one = serde_json::to_value(group).unwrap_or_default();
        let entries = at..at + group.entries.len();
        at = entries.end;
        one["first"] = json!(entries.start);
        one["low"] = range[0][entries.clone()].iter().map(short).collect();
        one["high"] = range[1][entries].iter().map(short).collect();
        one
    });
    described.collect()
}

/// The shortest decimal that is this number in single precision.
fn short(x: &f32) -> Value {
    x.to_string().parse::<f64>().map_or(Value::Null, Value::from)
}

fn range_note() -> String {
    format!(
        "an entry is (value - offset) * scale, and low and high are of entries: the least and the greatest in {} \
         flights of randomised vehicles with this policy's mean action and the noise of its training, half of them \
         from the pad and half from along the track, each for at most {} steps. Training itself, which explores, saw \
         more.",
        2 * seen::FLIGHTS,
        seen::STEPS
    )
}

fn actions(around: &Surroundings) -> Value {
    let rate = |k: usize| {
        json!({
            "name": ACTION_NAMES[k], "limits": [-1, 1], "unit": "rad/s", "frame": "body", "at_one": around.full_rate[k],
            "setpoint": format!("body_rate[{k}] = at_one * a[{k}]"),
        })
    };
    let thrust = json!({
        "name": ACTION_NAMES[3], "limits": [-1, 1], "unit": "1", "frame": "body z", "at_one": 1.0,
        "setpoint": "throttle = (a[3] + 1) / 2",
    });
    json!([rate(0), rate(1), rate(2), thrust])
}

fn setpoint(around: &Surroundings, mass_kg: f64) -> Value {
    json!({
        "hold": "for one control period; the flight controller's rate loop follows body_rate",
        "throttle": "0 no throttle, 1 full throttle",
        "thrust_n": "what the throttle settles at: c[0] + c[1] a + c[2] a^2 + c[3] a^3 + c[4] V + c[5] a V, a = a[3]",
        "coefficients_n": around.thrust_n,
        "mass_kg": mass_kg,
        "weight_n": around.weight_n,
        "thrust_to_weight": "thrust_n / weight_n: for a flight controller that takes a specific thrust or closes its \
                             own loop on the accelerometer; mind that its collective is then thrust, not throttle",
    })
}

fn filter(around: &Surroundings, time_constant_s: [f64; ACTIONS]) -> Value {
    json!({
        "formula": "after each answer u[k] += share[k] * (a[k] - u[k]), with share = 1 - exp(-period / time_constant)",
        "time_constant_s": time_constant_s,
        "share": around.share,
        "meaning": "u is the model of how far the vehicle has followed its commands. Nothing on a vehicle measures it: \
                    the computer that runs the policy keeps it, from its own answers alone, whatever the gyro says",
        "measured": "body rates in the observation are the measured ones, not u",
    })
}

fn self_test(shown: &Shown) -> Value {
    let rows = SelfTestRows::of(shown.steps);
    json!({
        "steps": rows.state.len(),
        "switches": self_test::switches(shown.steps).iter().filter(|&&step| step > 0).count(),
        "lap_s": shown.lap_s,
        "from": "consecutive steps of the nominal vehicle's flight from the pad, undisturbed, with u as in `filter`",
        "tensors": {
            "self_test.state": "position, velocity, attitude, body rates, voltage",
            "self_test.target": "the gate that is flown to, after this step's switch",
            "self_test.observation": "as described by `observation`",
            "self_test.action": "the answer",
            "self_test.setpoint": "body rates, throttle, thrust_n, thrust_to_weight",
        },
        "begin": "with u and the last three actions of the first observation, and the first target; then nothing but \
                  the states",
        "tolerance": {
            "observation": TOLERANCE, "target": 0, "action": TOLERANCE, "setpoint": SETPOINT_TOLERANCE,
        },
        "start_command": AT_START,
    })
}
