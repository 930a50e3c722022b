//! A flight as an MCAP file that Foxglove shows as it is: JSON messages of its well-known kinds, and plain ones to
//! plot.

use super::foxglove::{self, body, stamp};
use super::timed::{TimedMessage, write};
use super::{Replay, ReplayFrame};
use crate::base::error::{Error, Result};
use crate::race::env::observe::LAYOUT;
use serde_json::{Map, Value, json};

/// The bytes of the file. An error where times cannot be written.
///
/// | topic | message |
/// |---|---|
/// | `/tf` | `foxglove.FrameTransforms`: every vehicle in the frame `world` |
/// | `/track`, `/path`, `/vehicles` | `foxglove.SceneUpdate`: gates with names, paths coloured by speed, vehicles |
/// | `/poses` | `foxglove.PosesInFrame`: the first vehicle's flight |
/// | `/log` | `foxglove.Log`: gates passed, laps, failures |
/// | `/commands`, `/state` | `racer.Commands`, `racer.State` of the first vehicle |
/// | `/observation` | `racer.Observation`: what the policy saw, as the network gets it |
pub fn mcap(replay: &Replay) -> Result<Vec<u8>> {
    let mut messages = timeless(replay)?;
    for (i, vehicle) in replay.vehicles.iter().enumerate() {
        for frame in &vehicle.frames {
            let ns = at(replay, frame.time_s)?;
            let transform = json!({ "transforms": [foxglove::transform(ns, i, frame)] });
            messages.push(TimedMessage::new(ns, "/tf", "foxglove.FrameTransforms", transform));
            if i == 0 {
                messages.push(TimedMessage::new(ns, "/commands", "racer.Commands", commands(ns, frame)));
                messages.push(TimedMessage::new(ns, "/state", "racer.State", state(ns, frame)));
                if let Some(seen) = &frame.observation {
                    messages.push(TimedMessage::new(ns, "/observation", "racer.Observation", observation(ns, seen)));
                }
            }
        }
        messages.extend(remarks(replay, i)?);
    }
    // Stable: what was written first at a time stays first.
    messages.sort_by_key(|message| message.ns);
    write(&messages).map_err(Error::encode("the replay"))
}

fn at(replay: &Replay, time_s: f64) -> Result<u64> {
    let ns = i128::from(replay.start_ns) + (time_s * 1e9).round() as i128;
    let ns = u64::try_from(ns).ok().filter(|_| time_s.is_finite());
    ns.ok_or_else(|| Error::encode("the replay")("the flight has times that MCAP cannot represent"))
}

/// What is there from the first moment to the last.
fn timeless(replay: &Replay) -> Result<Vec<TimedMessage>> {
    let first = replay.vehicles.iter().filter_map(|v| v.frames.first()).map(|frame| frame.time_s);
    let ns = at(replay, first.fold(f64::INFINITY, f64::min))?;
    let top = replay.vehicles.iter().flat_map(|v| &v.frames).map(ReplayFrame::speed).fold(1.0, f64::max);
    let each = |entity: &dyn Fn(usize) -> Value| foxglove::scene((0..replay.vehicles.len()).map(entity).collect());
    const SCENE: &str = "foxglove.SceneUpdate";
    let mut messages = vec![
        TimedMessage::new(ns, "/path", SCENE, each(&|i| foxglove::path(ns, i, &replay.vehicles[i], top))),
        TimedMessage::new(ns, "/vehicles", SCENE, each(&|i| foxglove::model(ns, i))),
    ];
    if let Some(track) = &replay.track {
        messages.push(TimedMessage::new(ns, "/track", SCENE, foxglove::course(ns, track)));
    }
    if let Some(first) = replay.vehicles.first() {
        messages.push(TimedMessage::new(ns, "/poses", "foxglove.PosesInFrame", foxglove::poses(ns, first)));
    }
    Ok(messages)
}

/// Without numbers that are not known, which JSON has as null: a plot has a gap there.
fn known(mut message: Value) -> Value {
    if let Some(fields) = message.as_object_mut() {
        fields.retain(|_, value| !value.is_null());
        fields.values_mut().for_each(|value| *value = known(value.take()));
    }
    message
}

fn commands(ns: u64, frame: &ReplayFrame) -> Value {
    let [roll, pitch, yaw, thrust] = frame.command;
    known(json!({ "timestamp": stamp(ns), "roll": roll, "pitch": pitch, "yaw": yaw, "thrust": thrust }))
}

fn state(ns: u64, frame: &ReplayFrame) -> Value {
    let vector = |[x, y, z]: [f64; 3]| json!({ "x": x, "y": y, "z": z });
    known(json!({
        "timestamp": stamp(ns),
        "position_m": vector(frame.position),
        "velocity_m_s": vector(frame.velocity),
        "speed_m_s": frame.speed(),
        "body_rates_rad_s": vector(frame.rates),
        "voltage_v": frame.voltage,
        "target_gate": frame.target.map_or(-1, |gate| gate as i64),
    }))
}

fn observation(ns: u64, seen: &[f32]) -> Value {
    let mut rest = seen.iter();
    let mut all = Map::from_iter([("timestamp".to_string(), stamp(ns))]);
    for group in &LAYOUT {
        let entries = group.entries.iter().zip(&mut rest).map(|(name, &x)| (name.to_string(), json!(f64::from(x))));
        all.insert(group.name.into(), Value::Object(entries.collect()));
    }
    Value::Object(all)
}

fn remarks(replay: &Replay, i: usize) -> Result<Vec<TimedMessage>> {
    let vehicle = &replay.vehicles[i];
    let label = |gate: usize| replay.track.as_ref().map_or(gate.to_string(), |track| track.gate_label(gate));
    let mut said: Vec<(f64, String, bool)> =
        vehicle.passes.iter().map(|&(time, gate)| (time, format!("gate {}", label(gate)), false)).collect();
    if let Some(&(_, first)) = vehicle.passes.first() {
        let ends = vehicle.passes.iter().filter(|(_, gate)| *gate == first).skip(1);
        said.extend(ends.zip(&vehicle.laps).map(|((time, _), lap)| (*time, format!("lap {lap:.2} s"), false)));
    }
    if let (Some(failure), Some(last)) = (&vehicle.failure, vehicle.frames.last()) {
        said.push((last.time_s, format!("ended: {failure}"), true));
    }
    let messages = said.into_iter().map(|(time, text, failed)| {
        let ns = at(replay, time)?;
        Ok(TimedMessage::new(ns, "/log", "foxglove.Log", foxglove::remark(ns, &body(i), &text, failed)))
    });
    messages.collect()
}
