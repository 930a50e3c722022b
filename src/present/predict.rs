//! Measured and predicted signals as files: CSV, and MCAP for Foxglove.

use super::replay::timed::{TimedMessage, write};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::insight::predict::{PredictedChannel, Prediction};
use serde_json::{Map, Value, json};

/// Topics and schema names of the channels, by name.
const TOPICS: [(&str, &str); 7] = [
    ("roll rate", "/roll_rate"),
    ("pitch rate", "/pitch_rate"),
    ("yaw rate", "/yaw_rate"),
    ("specific force x", "/specific_force_x"),
    ("specific force y", "/specific_force_y"),
    ("specific force z", "/specific_force_z"),
    ("voltage", "/voltage"),
];

/// Names of what a vehicle adds to a row: the first without a number.
fn names(vehicle: usize) -> [String; 2] {
    ["predicted", "residual"].map(|name| if vehicle == 0 { name.into() } else { format!("{name}_{}", vehicle + 1) })
}

/// A line for each channel and sample: `log`, `time_s` since its start, `channel`, `unit`, `measured`, and for each
/// vehicle `predicted` and `residual` (measured less predicted), those of the second as `predicted_2`. All digits.
pub fn csv(prediction: &Prediction) -> Result<Vec<u8>> {
    encode::csv("the prediction", |csv| {
        let mut header = ["log", "time_s", "channel", "unit", "measured"].map(String::from).to_vec();
        (0..prediction.vehicles.len()).for_each(|k| header.extend(names(k)));
        csv.write_record(&header)?;
        for channel in &prediction.channels {
            for i in 0..channel.measured.len() {
                let log = &prediction.logs[channel.flight[i]].0;
                let (time, measured) = (channel.time_s[i].to_string(), channel.measured[i].to_string());
                let mut row = vec![log.clone(), time, channel.name.into(), channel.unit.into(), measured];
                for predicted in &channel.predicted {
                    row.extend([predicted[i].to_string(), (channel.measured[i] - predicted[i]).to_string()]);
                }
                csv.write_record(&row)?;
            }
        }
        Ok(())
    })
}

/// A topic each channel, with plain numbers to plot. An error where times cannot be written.
pub fn mcap(prediction: &Prediction) -> Result<Vec<u8>> {
    let mut messages = Vec::new();
    for channel in &prediction.channels {
        let topic = TOPICS.iter().find(|(name, _)| *name == channel.name).map_or("/other", |(_, topic)| topic);
        for i in 0..channel.measured.len() {
            let ns = stamp(prediction, channel, i)?;
            messages.push(TimedMessage::new(ns, topic, "racer.Prediction", message(channel, i, ns)));
        }
    }
    messages.sort_by_key(|message| message.ns);
    write(&messages).map_err(Error::encode("the prediction"))
}

fn stamp(prediction: &Prediction, channel: &PredictedChannel, i: usize) -> Result<u64> {
    let start = prediction.logs[channel.flight[i]].1;
    let ns = i128::from(start) + (channel.time_s[i] * 1e9).round() as i128;
    u64::try_from(ns).map_err(|_| Error::encode("the prediction")("the flight has times that MCAP cannot represent"))
}

fn message(channel: &PredictedChannel, i: usize, ns: u64) -> Value {
    let time = json!({ "sec": ns / 1_000_000_000, "nsec": ns % 1_000_000_000 });
    let mut all = Map::from_iter([("timestamp".to_string(), time), ("measured".into(), json!(channel.measured[i]))]);
    for (k, predicted) in channel.predicted.iter().enumerate() {
        let [name, residual] = names(k);
        all.insert(name, json!(predicted[i]));
        all.insert(residual, json!(channel.measured[i] - predicted[i]));
    }
    Value::Object(all)
}
