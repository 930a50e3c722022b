//! The observation (paper Eq. 10) and its layout.
//!
//! [`LAYOUT`] is the only place that says what an observation holds: the simulator, the documentation of a run and the
//! export of a policy all read it.

use super::gates::GateFrame;
use super::noise::Noise;
use crate::base::lane::{Lane, build, each};
use crate::model::attitude::{Quaternion, body_axes, cross};
use crate::model::vehicle::Battery;

/// Consecutive entries of the observation that belong together.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Group {
    pub name: &'static str,
    /// What the entries are, in order.
    pub entries: &'static [&'static str],
    pub unit: &'static str,
    pub frame: &'static str,
    /// How the values follow from what a flight computer knows; the letters are those of `Snapshot`'s description.
    pub formula: &'static str,
    /// An entry is (value - offset) * scale.
    pub offset: f64,
    pub scale: f64,
}

const XYZ: &[&str] = &["x", "y", "z"];
const COMMANDS: &[&str] = &["roll", "pitch", "yaw", "thrust"];

const fn group(
    name: &'static str,
    entries: &'static [&'static str],
    unit: &'static str,
    frame: &'static str,
    formula: &'static str,
    scale: f64,
) -> Group {
    Group { name, entries, unit, frame, formula, offset: 0.0, scale }
}

/// The observation's groups in order. "gate" is the frame of the target gate: x along the direction of crossing, y
/// left, z up, origin at its centre.
pub const LAYOUT: [Group; 11] = [
    group("position", XYZ, "m", "gate", "G (p - c)", 0.1),
    group("velocity", XYZ, "m/s", "gate", "G v", 0.1),
    group(
        "attitude",
        &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
        "1",
        "body axes in gate",
        "G R, column after column: the body's x axis in the gate frame, then its y axis, then its z axis",
        1.0,
    ),
    group("angular_rate", XYZ, "rad/s", "gate", "G R w", 0.1),
    group("command", COMMANDS, "1", "filtered command u", "u", 1.0),
    group("action_1", COMMANDS, "1", "action one step ago", "the policy's own answer one step ago", 1.0),
    group("action_2", COMMANDS, "1", "action two steps ago", "the policy's own answer two steps ago", 1.0),
    group("action_3", COMMANDS, "1", "action three steps ago", "the policy's own answer three steps ago", 1.0),
    group("voltage", &["V"], "V", "battery", "V", 1.0), // offset and scale: see `layout`
    group("next_gate", XYZ, "m", "gate", "G (c1 - c)", 0.1),
    group("second_gate", XYZ, "m", "gate", "G (c2 - c)", 0.1),
];

/// Index of the group whose offset and scale depend on the vehicle.
const VOLTAGE: usize = {
    let mut i = 0;
    while !matches!(LAYOUT[i].name.as_bytes(), b"voltage") {
        i += 1;
    }
    i
};

/// [`LAYOUT`] for a policy trained with `battery`: its voltage goes from -1, empty, to 1, full.
pub fn layout(battery: &Battery) -> [Group; LAYOUT.len()] {
    let mut layout = LAYOUT;
    [layout[VOLTAGE].offset, layout[VOLTAGE].scale] = voltage_scale(battery);
    layout
}

/// Offset and scale of the voltage.
pub fn voltage_scale(battery: &Battery) -> [f64; 2] {
    [0.5 * (battery.full_v + battery.empty_v), 2.0 / (battery.full_v - battery.empty_v)]
}

/// Entries of an observation.
pub const OBSERVATIONS: usize = {
    let (mut n, mut i) = (0, 0);
    while i < LAYOUT.len() {
        n += LAYOUT[i].entries.len();
        i += 1;
    }
    n
};

/// Where the group `name` begins in an observation.
pub const fn first_entry(name: &str) -> usize {
    let (mut n, mut i) = (0, 0);
    while i < LAYOUT.len() {
        if same(LAYOUT[i].name.as_bytes(), name.as_bytes()) {
            return n;
        }
        n += LAYOUT[i].entries.len();
        i += 1;
    }
    panic!("no such group")
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

#[inline(always)]
fn add<L: Lane>(a: [L; 3], b: [L; 3]) -> [L; 3] {
    build!(|i| a[i] + b[i])
}

/// (offset, scale) of each entry.
const SCALES: [(f32, f32); OBSERVATIONS] = {
    let mut all = [(0.0, 0.0); OBSERVATIONS];
    let (mut k, mut g) = (0, 0);
    while g < LAYOUT.len() {
        let end = k + LAYOUT[g].entries.len();
        while k < end {
            all[k] = (LAYOUT[g].offset as f32, LAYOUT[g].scale as f32);
            k += 1;
        }
        g += 1;
    }
    all
};

/// What an observation is made of, of 16 vehicles.
pub struct ObservationInputs<'a, L> {
    /// The target gates, and the positions in their frames, m.
    pub gate: &'a GateFrame<L>,
    pub in_gate: [L; 3],
    /// World, m/s.
    pub velocity: [L; 3],
    /// Body to world.
    pub attitude: Quaternion<L>,
    /// About the body's axes, rad/s.
    pub body_rates: [L; 3],
    /// Filtered commands, and the last three actions, newest first.
    pub command: &'a [L; 4],
    pub history: &'a [[L; 4]; 3],
    /// Of the battery's terminals, V.
    pub voltage: L,
}

/// Writes the observation of 16 lanes, entry `k` to `out[k * stride..]`, with `noise` on what an estimator would have
/// to estimate. `voltage_scale` is the offset and scale of the voltage.
#[inline(always)]
pub fn observe<L: Lane<Elem = f32>>(
    seen: &ObservationInputs<L>,
    noise: Option<&Noise<L>>,
    voltage_scale: [f64; 2],
    out: &mut [f32],
    stride: usize,
) {
    let gate = seen.gate;
    let mut position = seen.in_gate;
    let mut velocity = gate.rotate(seen.velocity);
    let axes = body_axes(seen.attitude);
    let mut attitude = each!(axes, |axis| gate.rotate(axis));
    let body_rates = seen.body_rates;
    let mut rates: [L; 3] = build!(|i| {
        attitude[0][i].mul_add(body_rates[0], attitude[1][i].mul_add(body_rates[1], attitude[2][i] * body_rates[2]))
    });
    let mut voltage = seen.voltage;
    if let Some(noise) = noise {
        position = add(position, noise.position);
        velocity = add(velocity, noise.velocity);
        rates = add(rates, noise.rate);
        attitude = each!(attitude, |axis| add(axis, cross(noise.attitude, axis)));
        voltage = voltage + noise.voltage;
    }
    let attitude = attitude.as_flattened();
    let groups: [&[L]; LAYOUT.len()] = [
        &position,
        &velocity,
        attitude,
        &rates,
        seen.command,
        &seen.history[0],
        &seen.history[1],
        &seen.history[2],
        &[(voltage - L::of(voltage_scale[0])) * L::of(voltage_scale[1])],
        &gate.next[0],
        &gate.next[1],
    ];
    let mut k = 0;
    for values in groups {
        for &value in values {
            let (offset, scale) = SCALES[k];
            ((value - L::splat(offset)) * L::splat(scale)).write(&mut out[k * stride..]);
            k += 1;
        }
    }
    debug_assert_eq!(k, OBSERVATIONS);
}
