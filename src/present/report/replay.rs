//! A flight in three dimensions, as one page that needs nothing else: no network, no library.

use crate::model::track::{GateKind, Track};
use crate::present::replay::{Replay, ReplayVehicle};
use serde_json::{Value, json};

const STYLE: &str = include_str!("replay/page.css");
const BODY: &str = include_str!("replay/body.html");
/// In this order: each uses what stands before it.
const SCRIPTS: [&str; 5] = [
    include_str!("replay/flight.js"),
    include_str!("replay/camera.js"),
    include_str!("replay/scene.js"),
    include_str!("replay/panel.js"),
    include_str!("replay/play.js"),
];
/// Most moments that a page holds of each vehicle; of longer flights, every second, third, ...
const MOMENTS: usize = 8000;

/// The page.
pub fn page(replay: &Replay) -> String {
    // `<` would let a name end the script.
    let data = data(replay).to_string().replace('<', "\\u003c");
    let title = replay.title.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n{BODY}\n\
         <script type=\"application/json\" id=\"data\">{data}</script>\n<script>\n\
         \"use strict\";\n{}</script>\n</body>\n</html>\n",
        SCRIPTS.join("\n")
    )
}

fn data(replay: &Replay) -> Value {
    json!({
        "title": replay.title,
        "track": replay.track.as_ref().map(track),
        "vehicles": replay.vehicles.iter().map(vehicle).collect::<Vec<_>>(),
    })
}

/// Rounded, for a small page; what is not known becomes null.
fn round(x: f64, digits: i32) -> Value {
    let scale = 10f64.powi(digits);
    json!((x * scale).round() / scale)
}

fn rounded<const N: usize>(values: [f64; N], digits: i32) -> [Value; N] {
    values.map(|x| round(x, digits))
}

fn track(track: &Track) -> Value {
    let gates = track.gates.iter().enumerate().map(|(i, gate)| {
        let rotation = gate.rotation();
        json!({
            "label": track.gate_label(i),
            "centre": gate.position_m,
            "left": <[f64; 3]>::from(rotation.column(1)),
            "up": <[f64; 3]>::from(rotation.column(2)),
            "forward": <[f64; 3]>::from(rotation.column(0)),
            "radius": gate.radius_m,
            "outer": gate.outer_m.unwrap_or(2.0 * gate.radius_m + 0.3),
            "virtual": gate.kind == GateKind::Virtual,
        })
    });
    let spline = track.reset_spline().samples(300).into_iter().map(|s| rounded(s.position.into(), 2));
    json!({
        "name": track.name,
        "gates": gates.collect::<Vec<_>>(),
        "start": track.start.position_m,
        "spline": spline.collect::<Vec<_>>(),
    })
}

/// Columns, because they are shorter than records.
fn vehicle(vehicle: &ReplayVehicle) -> Value {
    let stride = vehicle.frames.len().div_ceil(MOMENTS).max(1);
    let frames: Vec<_> = vehicle.frames.iter().step_by(stride).collect();
    let all = |digits: i32, of: &dyn Fn(usize) -> Vec<f64>| -> Vec<Value> {
        (0..frames.len()).flat_map(of).map(|x| round(x, digits)).collect()
    };
    json!({
        "name": vehicle.name,
        "time": all(3, &|i| vec![frames[i].time_s]),
        "position": all(3, &|i| frames[i].position.into()),
        "velocity": all(2, &|i| frames[i].velocity.into()),
        "attitude": all(4, &|i| frames[i].attitude.into()),
        "rates": all(2, &|i| frames[i].rates.into()),
        "command": all(3, &|i| frames[i].command.into()),
        "voltage": all(2, &|i| vec![frames[i].voltage]),
        "target": frames.iter().map(|frame| frame.target).collect::<Vec<_>>(),
        "passes": vehicle.passes.iter().map(|(time, gate)| json!([round(*time, 3), gate])).collect::<Vec<_>>(),
        "laps": vehicle.laps.iter().map(|lap| round(*lap, 3)).collect::<Vec<_>>(),
        "failure": vehicle.failure,
    })
}
