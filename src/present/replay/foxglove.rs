//! Foxglove's well-known messages as JSON.
//!
//! Names of messages and fields: Foxglove's published schemas (docs.foxglove.dev/docs/visualization/message-schemas).

use super::{ReplayFrame, ReplayVehicle};
use crate::model::track::{Gate, GateKind, Track};
use crate::present::colour::viridis;
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use serde_json::{Value, json};

pub const WORLD: &str = "world";

/// The frame of vehicle `i`.
pub fn body(i: usize) -> String {
    if i == 0 { "base_link".into() } else { format!("vehicle_{i}") }
}

pub fn stamp(ns: u64) -> Value {
    json!({ "sec": ns / 1_000_000_000, "nsec": ns % 1_000_000_000 })
}

fn vector([x, y, z]: [f64; 3]) -> Value {
    json!({ "x": x, "y": y, "z": z })
}

fn quaternion([w, x, y, z]: [f64; 4]) -> Value {
    json!({ "x": x, "y": y, "z": z, "w": w })
}

fn pose(position: [f64; 3], attitude: [f64; 4]) -> Value {
    json!({ "position": vector(position), "orientation": quaternion(attitude) })
}

const LEVEL: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
const SLATE: [f64; 4] = [0.22, 0.27, 0.33, 1.0];
const ORANGE: [f64; 4] = [0.84, 0.37, 0.0, 1.0];
const BLUE: [f64; 4] = [0.0, 0.45, 0.7, 1.0];
const PALE: [f64; 4] = [0.5, 0.55, 0.6, 0.5];

fn colour([r, g, b, a]: [f64; 4]) -> Value {
    json!({ "r": r, "g": g, "b": b, "a": a })
}

/// `foxglove.FrameTransform` of a vehicle.
pub fn transform(ns: u64, i: usize, frame: &ReplayFrame) -> Value {
    json!({
        "timestamp": stamp(ns),
        "parent_frame_id": WORLD,
        "child_frame_id": body(i),
        "translation": vector(frame.position),
        "rotation": quaternion(frame.attitude),
    })
}

/// An entity of `foxglove.SceneUpdate` that stays.
fn entity(ns: u64, frame: &str, id: &str, locked: bool, parts: Value) -> Value {
    let mut entity = json!({
        "timestamp": stamp(ns),
        "frame_id": frame,
        "id": id,
        "lifetime": { "sec": 0, "nsec": 0 },
        "frame_locked": locked,
        "metadata": [],
        "arrows": [], "cubes": [], "spheres": [], "cylinders": [],
        "lines": [], "triangles": [], "texts": [], "models": [],
    });
    if let (Some(all), Value::Object(parts)) = (entity.as_object_mut(), parts) {
        all.extend(parts);
    }
    entity
}

pub fn scene(entities: Vec<Value>) -> Value {
    json!({ "deletions": [], "entities": entities })
}

/// Gates as frames with their names, the start, and the reset spline.
pub fn course(ns: u64, track: &Track) -> Value {
    let mut entities: Vec<Value> = track
        .gates
        .iter()
        .enumerate()
        .map(|(i, gate)| {
            let label = track.gate_label(i);
            let parts = json!({ "cubes": bars(gate), "texts": [name(&label, gate)] });
            entity(ns, WORLD, &format!("gate {label}"), false, parts)
        })
        .collect();
    let mut start = track.start.position_m;
    start[2] = 0.02;
    let pad = json!({ "pose": pose(start, LEVEL), "size": vector([0.6, 0.6, 0.04]), "color": colour(BLUE) });
    entities.push(entity(ns, WORLD, "start", false, json!({ "cubes": [pad] })));
    let points = track.reset_spline().samples(400).into_iter().map(|s| vector(s.position.into())).collect();
    entities.push(entity(
        ns,
        WORLD,
        "reset spline",
        false,
        json!({ "lines": [line(1, 1.0, points, PALE, Vec::new())] }),
    ));
    scene(entities)
}

/// Four bars around the opening; virtual gates thin and pale.
fn bars(gate: &Gate) -> Vec<Value> {
    let turned = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(gate.rotation()));
    let attitude = [turned.w, turned.i, turned.j, turned.k];
    let inner = gate.radius_m;
    let outer = (0.5 * gate.outer_m.unwrap_or(2.0 * inner + 0.2)).max(inner + 0.05);
    let (width, middle, solid) = match gate.kind {
        GateKind::Physical => (outer - inner, 0.5 * (outer + inner), SLATE),
        GateKind::Virtual => (0.04, inner, PALE),
    };
    let sides = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
    sides
        .into_iter()
        .map(|(left, up)| {
            let place = gate.position() + gate.rotation() * Vector3::new(0.0, left * middle, up * middle);
            let size =
                if left == 0.0 { [0.06, 2.0 * middle + width, width] } else { [0.06, width, 2.0 * middle - width] };
            json!({ "pose": pose(place.into(), attitude), "size": vector(size), "color": colour(solid) })
        })
        .collect()
}

fn name(label: &str, gate: &Gate) -> Value {
    let above = gate.position() + Vector3::z() * (0.5 * gate.outer_m.unwrap_or(2.0 * gate.radius_m) + 0.35);
    json!({
        "pose": pose(above.into(), LEVEL),
        "billboard": true,
        "font_size": 0.5,
        "scale_invariant": false,
        "color": colour([0.1, 0.1, 0.1, 1.0]),
        "text": label,
    })
}

/// Most places of a path: of longer flights every second, third, ...
const PLACES: usize = 5000;

/// `kind` 0: a strip of lines; 1: a closed one.
fn line(kind: u8, thickness: f64, points: Vec<Value>, solid: [f64; 4], colours: Vec<Value>) -> Value {
    json!({
        "type": kind,
        "pose": pose([0.0; 3], LEVEL),
        "thickness": thickness,
        "scale_invariant": true,
        "points": points,
        "color": colour(solid),
        "colors": colours,
        "indices": [],
    })
}

/// Frames of a path, at most [`PLACES`] and one.
fn kept(vehicle: &ReplayVehicle) -> impl Iterator<Item = &ReplayFrame> {
    vehicle.frames.iter().step_by(vehicle.frames.len().div_ceil(PLACES).max(1))
}

/// The whole path of a vehicle; that of the first coloured by speed, of at most `top` m/s.
pub fn path(ns: u64, i: usize, vehicle: &ReplayVehicle, top: f64) -> Value {
    let points = kept(vehicle).map(|frame| vector(frame.position)).collect();
    let shade = |frame: &ReplayFrame| {
        let plotters::style::RGBColor(r, g, b) = viridis(frame.speed() / top);
        colour([f64::from(r) / 255.0, f64::from(g) / 255.0, f64::from(b) / 255.0, 1.0])
    };
    let colours = if i == 0 { kept(vehicle).map(shade).collect() } else { Vec::new() };
    let line = line(0, if i == 0 { 3.0 } else { 1.0 }, points, PALE, colours);
    entity(ns, WORLD, &format!("path of {}", body(i)), false, json!({ "lines": [line] }))
}

/// The vehicle itself, which moves with its frame: two arms, a nose, four rotors.
pub fn model(ns: u64, i: usize) -> Value {
    let solid = if i == 0 { SLATE } else { PALE };
    let arm = |angle: f64| {
        let attitude = [(0.5 * angle).cos(), 0.0, 0.0, (0.5 * angle).sin()];
        json!({ "pose": pose([0.0; 3], attitude), "size": vector([0.5, 0.04, 0.03]), "color": colour(solid) })
    };
    let quarter = std::f64::consts::FRAC_PI_4;
    let nose =
        json!({ "pose": pose([0.13, 0.0, 0.02], LEVEL), "size": vector([0.1, 0.06, 0.05]), "color": colour(ORANGE) });
    let rotors: Vec<Value> = [1.0, 3.0, 5.0, 7.0]
        .map(|k: f64| {
            let (sin, cos) = (k * quarter).sin_cos();
            json!({
                "pose": pose([0.25 * cos, 0.25 * sin, 0.04], LEVEL),
                "size": vector([0.26, 0.26, 0.01]),
                "color": colour(if i == 0 { BLUE } else { PALE }),
                "bottom_scale": 1.0,
                "top_scale": 1.0,
            })
        })
        .into();
    let cubes = json!([arm(quarter), arm(-quarter), nose]);
    entity(ns, &body(i), &body(i), true, json!({ "cubes": cubes, "cylinders": rotors }))
}

/// `foxglove.PosesInFrame` of a flight.
pub fn poses(ns: u64, vehicle: &ReplayVehicle) -> Value {
    let poses: Vec<_> = kept(vehicle).map(|frame| pose(frame.position, frame.attitude)).collect();
    json!({ "timestamp": stamp(ns), "frame_id": WORLD, "poses": poses })
}

/// `foxglove.Log`, a remark, or a warning where a flight `failed`.
pub fn remark(ns: u64, vehicle: &str, message: &str, failed: bool) -> Value {
    const INFO: u8 = 2;
    const WARNING: u8 = 3;
    let level = if failed { WARNING } else { INFO };
    json!({ "timestamp": stamp(ns), "level": level, "message": message, "name": vehicle, "file": "", "line": 0 })
}
