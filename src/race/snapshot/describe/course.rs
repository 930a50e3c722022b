//! Where a policy flies: start, gates, limits.

use crate::model::track::{GateKind, Track};
use crate::model::vehicle::Vehicle;
use crate::race::env::EnvConfig;
use crate::race::onboard::AT_START;
use serde_json::{Value, json};

pub fn start(track: &Track, vehicle: &Vehicle) -> Value {
    json!({
        "position_m": track.start.position_m,
        "heading_rad": track.start.heading_rad(),
        "command": AT_START,
        "actions": [AT_START, AT_START, AT_START],
        "target": 0,
        "voltage_v": vehicle.battery.full_v,
        "note": "at rest and level, x forward along the heading, counter-clockwise from east",
    })
}

pub fn gates(track: &Track, env: &EnvConfig) -> Value {
    let n = track.gates.len();
    let list = (0..n).map(|i| {
        let gate = &track.gates[i];
        let rotation = gate.rotation();
        let to = |k: usize| {
            let offset = rotation.transpose() * (track.gates[(i + k) % n].position() - gate.position());
            <[f64; 3]>::from(offset)
        };
        let axes: Vec<[f64; 3]> = (0..3).map(|k| rotation.column(k).into_owned().into()).collect();
        let physical = gate.kind == GateKind::Physical;
        json!({
            "label": track.gate_label(i),
            "physical": physical,
            "centre_m": gate.position_m,
            "axes": axes,
            "radius_m": gate.radius_m,
            "training_radius_m": if physical { env.gate_radius_m.min(gate.radius_m) } else { gate.radius_m },
            "next_m": to(1),
            "second_m": to(2),
        })
    });
    json!({
        "order": "as listed, cyclic; a lap is all of them and the first again",
        "switch": "with each new state, before the observation: where the gate-frame x of the last position is below 0 \
                   and that of this one is 0 or more, and the straight line between them meets the plane x = 0 within \
                   radius_m of the centre, the next gate becomes the target. At most one switch a step; not before the \
                   second state",
        "missed": "a plane that was crossed outside radius_m ends a flight in the simulator: the policy has never seen \
                   what comes then. Keep the target, and give control back",
        "radius": "radius_m counts; training_radius_m was the aperture while training, so that passing leaves a margin",
        "axes": "x, y, z of the gate in the world, one a row: this is G",
        "pitch": "a gate's pitch is positive where its direction of crossing points upwards",
        "next_m": "G (c1 - c) and G (c2 - c): seen from this gate and not from the vehicle",
        "list": list.collect::<Vec<_>>(),
    })
}

pub fn limits(track: &Track, vehicle: &Vehicle, env: &EnvConfig) -> Value {
    json!({
        "volume_m": [track.volume.min_m, track.volume.max_m],
        "empty_v": vehicle.battery.empty_v,
        "gate_timeout_s": env.gate_timeout_s,
        "note": "flights in training ended outside of these",
    })
}
