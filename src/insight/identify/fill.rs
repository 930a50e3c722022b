//! What was found and what was judged of it, into the result.

mod assumed;
mod rate;
pub mod thrust;

use super::estimate::Estimated;
use super::fits::Fits;
use super::judge::Accepted;
use super::rates::Compared;
use super::result::{ComparedChannel, Identification, Response};
use super::{IdentifyOptions, battery};
use crate::insight::predict::{PredictedChannel, Prediction};
use crate::insight::prepare::data::Data;
use crate::model::effects;
use crate::model::vehicle::AXES;

/// Everything but the vehicle's numbers themselves.
pub fn fill(
    out: &mut Identification,
    data: &Data,
    all: &Fits,
    [train, validation]: &[Prediction; 2],
    judged: Accepted,
    full: Estimated,
    options: &IdentifyOptions,
) {
    out.kept = judged.kept;
    for channel in &validation.channels {
        if shown(channel.name, all) {
            let learned = train.channels.iter().find(|c| c.name == channel.name);
            out.channels.push(compared(channel, learned));
        }
    }
    for axis in 0..3 {
        rate::rate(out, data, axis, all, &judged, options);
    }
    controller(out, all);
    pack(out, all, &judged);
    thrust::thrust(out, all, &judged, full);
    thrust::drag(out, all, &judged);
    bias(out, all);
    for (key, why) in &judged.left {
        out.assume(key, why);
    }
    assumed::say_what_matters(out, options);
}

/// Whether a channel is of something that was fitted.
fn shown(name: &str, all: &Fits) -> bool {
    match AXES.iter().position(|axis| name.starts_with(axis)) {
        Some(axis) => all.rates[axis].is_ok(),
        None if name == "voltage" => all.battery.is_ok(),
        None if name.ends_with('z') => all.thrust.is_ok(),
        None => all.thrust.is_ok() && all.no_drag.is_none(),
    }
}

fn compared(validation: &PredictedChannel, train: Option<&PredictedChannel>) -> ComparedChannel {
    let one = |c: &PredictedChannel| Compared {
        time: c.time_s.clone(),
        measured: c.measured.clone(),
        predicted: c.predicted[0].clone(),
    };
    ComparedChannel {
        name: validation.name.into(),
        unit: validation.unit,
        train: train.map(one).unwrap_or_default(),
        validation: one(validation),
    }
}

/// A response, with the scores of its channel.
fn response(out: &Identification, name: &str, tau_s: Estimated, offset: Estimated) -> Response {
    let Some(channel) = out.channels.iter().find(|channel| channel.name == name) else {
        return Response { tau_s, offset, ..Response::default() };
    };
    let score = channel.score();
    Response {
        tau_s,
        offset,
        rmse: Some(score.rmse),
        mae: Some(score.mae),
        r2: Some(score.r2),
        n_train: channel.train.measured.len(),
        n_validation: score.n,
        unit: channel.unit,
    }
}

/// The estimate, or that it was left, and why.
fn judged(estimate: Estimated, key: &str, judged: &Accepted) -> Estimated {
    match judged.left.get(key) {
        Some(why) => estimate.left(why),
        None => estimate,
    }
}

/// What the vehicle has of a flight controller's answer.
fn controller(out: &mut Identification, all: &Fits) {
    for (part, size) in all.controller(&out.kept) {
        if let Some(card) = effects::of_controller(part) {
            out.found(&format!("effects.sizes.{}.{}", card.id, card.parameters[0].name), size.interval());
        }
        out.controller.insert(part, size.clone());
    }
}

fn pack(out: &mut Identification, all: &Fits, verdict: &Accepted) {
    let fit = match &all.battery {
        Ok(fit) => fit,
        Err(why) => {
            out.battery.initial_v = Estimated::unknown(why);
            out.battery.rate_v_s = Estimated::unknown(why);
            return;
        }
    };
    let rate = judged(Estimated::of(fit, battery::RATE), "battery.rate_v_s", verdict);
    out.battery.initial_v = judged(Estimated::of(fit, battery::INITIAL), "battery", verdict);
    out.battery.rate_v_s = judged(rate, "battery", verdict);
    out.battery.score = out.channels.iter().find(|c| c.name == "voltage").map(ComparedChannel::score);
    if verdict.kept.volts {
        out.found("battery.full_v", out.battery.initial_v.interval());
        out.found("battery.empty_v", None);
    }
    if verdict.kept.discharge {
        out.found("battery.rate_v_s", out.battery.rate_v_s.interval());
    }
}

fn bias(out: &mut Identification, all: &Fits) {
    out.accelerometer_bias_m_s2 = match &all.bias {
        Some(bias) => [0, 1, 2].map(|k| Estimated::of(bias, k)),
        None => {
            let why = "no odometry fast enough to tell it from thrust; c0 contains it";
            std::array::from_fn(|_| Estimated::unknown(why))
        }
    };
}
