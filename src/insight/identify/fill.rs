//! What was found and what was judged of it, into the result.

use super::estimate::Estimated;
use super::fits::Fits;
use super::force::{DRAG_AT, TAU, THRUST};
use super::judge::Accepted;
use super::rates::{Compared, RateAxis};
use super::result::{ComparedChannel, Identification, Response};
use super::solve::Solution;
use super::{AXES, IdentifyOptions, battery};
use crate::base::stats::{NORMAL_95, quantile};
use crate::insight::criteria::identified::BEYOND_FULL_STICK;
use crate::insight::criteria::shown::{REMARKED_DELAY_S, REMARKED_ERROR, REMARKED_R2};
use crate::insight::predict::{PredictedChannel, Prediction};
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::thrust::shape;
use crate::model::vehicle::Vehicle;

/// Thrust of the command `u` and full pack, N. What the limits of a curve leave no room for is not in the interval.
pub fn thrust_of(all: &Fits, whole: &Vehicle, u: f64) -> Estimated {
    let Ok(fit) = &all.thrust else { return Estimated::default() };
    let (mass, v) = (whole.mass_kg, whole.battery.full_v);
    let row = shape::at(u, v);
    let own = |i: usize, j: usize| fit.solution.covariance[(THRUST + i, THRUST + j)];
    let variance: f64 =
        (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).map(|(i, j)| row[i] * own(i, j) * row[j]).sum();
    let half = NORMAL_95 * mass * variance.max(0.0).sqrt();
    let value = whole.thrust_at(u, v);
    let [least, most] = if u > fit.flown[1] {
        shape::beyond(&whole.thrust_n, v, fit.flown[1], u)
    } else {
        [f64::NEG_INFINITY, f64::INFINITY]
    };
    Estimated {
        value: Some(value),
        low: Some((value - half).max(least.min(value))),
        high: Some((value + half).min(most.max(value))),
        why: None,
    }
}

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
        rate(out, data, axis, all, &judged, options);
    }
    pack(out, all, &judged);
    thrust(out, all, &judged, full);
    drag(out, all, &judged);
    bias(out, all);
    for (key, why) in &judged.left {
        out.assume(key, why);
    }
    say_what_matters(out, data);
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

fn rate(out: &mut Identification, data: &Data, axis: usize, all: &Fits, verdict: &Accepted, options: &IdentifyOptions) {
    let name = AXES[axis];
    let (lag_key, rate_key) = (format!("time_constant_s.{name}"), format!("max_rate_deg_s.{name}"));
    let fit = match &all.rates[axis] {
        Ok(fit) => fit,
        Err(why) => {
            out.response[axis] = Response { tau_s: Estimated::unknown(why), ..Response::default() };
            out.max_rate_rad_s[axis] = Estimated::unknown(why);
            return;
        }
    };
    let degrees = 1f64.to_degrees();
    let tau = judged(Estimated::of(fit, 0), &lag_key, verdict);
    out.response[axis] = response(out, &format!("{name} rate"), tau, Estimated::of(fit, 2).times(degrees));
    let gain = Estimated::of(fit, 1);
    let assumed = out.lent("full_rate_deg_s").is_some();
    let most = gain.times(out.full_rate_rad_s[axis]);
    let most = if assumed && verdict.kept.rate[axis] {
        // Only the share of the setpoint was measured.
        let [low, high] = gain.interval().unwrap_or([f64::NAN; 2]);
        most.left(&format!("{low:.3} to {high:.3} of one that is assumed, see below"))
    } else {
        judged(most, &rate_key, verdict)
    };
    out.max_rate_rad_s[axis] = most;
    if verdict.kept.lag[axis] {
        out.found(&lag_key, out.response[axis].tau_s.interval());
    }
    if verdict.kept.rate[axis] {
        if assumed {
            let why =
                "the log tells its share of the full-stick rate, and that is the base vehicle's: give --full-rates";
            out.assume(&rate_key, why);
        } else {
            out.found(&rate_key, out.max_rate_rad_s[axis].times(degrees).interval());
        }
    }
    delay(out, data, axis, options);
}

/// Says where a pure delay would predict a rate better than the lag alone.
fn delay(out: &mut Identification, data: &Data, axis: usize, options: &IdentifyOptions) {
    let response = &out.response[axis];
    if response.r2.is_none_or(|r2| r2 >= REMARKED_R2.get()) {
        return;
    }
    let rate = RateAxis::new(data, axis, options.rate_cutoff_hz);
    let (Some(plain), Some(late)) = (rate.fit(DataPart::Train, false), rate.fit(DataPart::Train, true)) else { return };
    let [plain, better] = [&plain, &late].map(|fit| rate.score(DataPart::Validation, fit));
    if late.values[3] > REMARKED_DELAY_S.get() && better.rmse < REMARKED_ERROR.get() * plain.rmse {
        out.remark(format!(
            "{}: a pure delay of {:.0} ms before a lag of {:.0} ms would bring R2 from {:.3} to {:.3}; the model has \
             none",
            AXES[axis],
            1e3 * late.values[3],
            1e3 * late.values[0],
            plain.r2,
            better.r2
        ));
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

fn thrust(out: &mut Identification, all: &Fits, verdict: &Accepted, full: Estimated) {
    let fit = match &all.thrust {
        Ok(fit) => fit,
        Err(why) => {
            out.response[3].tau_s = Estimated::unknown(why);
            out.thrust_n = std::array::from_fn(|_| Estimated::unknown(why));
            out.thrust.full_n = Estimated::unknown(why);
            return;
        }
    };
    let mass = out.vehicle.mass_kg;
    let tau = if fit.lags { Estimated::of(&fit.solution, TAU) } else { Estimated::default() };
    let tau = judged(tau, "time_constant_s.thrust", verdict);
    let offset = all.bias.as_ref().map_or_else(Estimated::default, |bias| Estimated::of(bias, 2));
    out.response[3] = response(out, "specific force z", tau, offset);
    out.flown = Some(fit.flown);
    let why = "the voltage tells nothing of it";
    let coefficient = |k: usize| {
        if k > 3 && all.no_voltage.is_some() {
            return Estimated::unknown(all.no_voltage.as_deref().unwrap_or(why));
        }
        judged(coefficient(&fit.solution, k, all).times(mass), "thrust_n", verdict)
    };
    out.thrust_n = std::array::from_fn(coefficient);
    let over_motors = |s: &Solution| std::array::from_fn(|k| s.values[THRUST + k] * mass);
    let words = &mut out.thrust;
    words.source = fit.source;
    words.full_n = judged(full, "thrust_n", verdict);
    words.over_motors_n = fit.motors.as_ref().map(over_motors);
    words.rotor_lag_s = fit.motors.as_ref().map_or_else(Estimated::default, |s| Estimated::of(s, TAU));
    words.command_lag_s = fit.chain.and_then(|chain| chain.command_lag_s);
    words.command_r2 = fit.mixer.as_ref().map(|mixer| mixer.score.r2);
    if !verdict.kept.thrust {
        return;
    }
    let pack = out.vehicle.battery;
    words.hover_throttle = Some(0.5 + 0.5 * out.vehicle.hover_command(0.5 * (pack.full_v + pack.empty_v)));
    words.flown_throttle = Some(fit.flown.map(|u| 0.5 + 0.5 * u));
    for k in 0..6 {
        out.found(&format!("thrust_n[{k}]"), out.thrust_n[k].interval());
    }
    out.found("thrust_n", None);
    if verdict.kept.lag[3] {
        out.found("time_constant_s.thrust", out.response[3].tau_s.interval());
    }
    if let Some(why) = &all.no_voltage {
        out.remark(format!("thrust over voltage: {why}; c4 = c5 = 0"));
    }
    if fit.motors.is_some() && fit.mixer.is_none() {
        let text = "the collective command does not tell the motor outputs: a policy's command is taken for their mean";
        out.remark(format!("thrust: {text}"));
    }
}

/// A coefficient of the curve; c0 takes over what is uncertain about the accelerometer's bias.
fn coefficient(solution: &Solution, k: usize, all: &Fits) -> Estimated {
    let own = Estimated::of(solution, THRUST + k);
    match (&all.bias, own.value, own.high) {
        (Some(bias), Some(value), Some(high)) if k == 0 => {
            Estimated::new(value, (high - value).hypot(bias.half_width(2)))
        }
        _ => own,
    }
}

/// The logs tell three numbers, drag over mass along each axis; four make the ellipsoid. The coefficient stays the base
/// vehicle's, and the semi-axes follow.
fn drag(out: &mut Identification, all: &Fits, verdict: &Accepted) {
    let fit = match (&all.thrust, &all.no_drag) {
        (Ok(fit), None) => fit,
        (_, Some(why)) | (Err(why), None) => {
            out.drag.k_1_m = std::array::from_fn(|_| Estimated::unknown(why));
            return;
        }
    };
    out.drag.k_1_m = [0, 1, 2].map(|i| judged(Estimated::of(&fit.solution, DRAG_AT + i), "drag", verdict));
    if !verdict.kept.drag {
        return;
    }
    for (axis, estimate) in ["x", "y", "z"].iter().zip(out.drag.k_1_m.clone()) {
        if estimate.low.is_none() {
            out.remark(format!("drag along {axis} ended at the bound of the search"));
        }
        out.found(&format!("drag_over_mass_1_m.{axis}"), estimate.interval());
    }
    out.found("drag.semi_axes_m", None);
    out.drag.semi_axes_m = Some(out.vehicle.drag.semi_axes_m);
    out.drag.coefficient = Some(out.vehicle.drag.coefficient);
    out.drag.flown_m_s = out.fastest_m_s;
    out.assume("drag.coefficient", "the size of the body and its coefficient act alike; the semi-axes follow from it");
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

/// What was assumed and decides how the vehicle flies.
fn say_what_matters(out: &mut Identification, data: &Data) {
    if out.lent("full_rate_deg_s").is_some() && out.kept.rate.contains(&true) {
        let most = |k: usize| {
            let all = data.flights.iter().flat_map(|f| f.quality.log.setpoint.column(k));
            quantile(&all.filter(|w| w.is_finite()).map(f64::abs).collect::<Vec<_>>(), 0.999)
        };
        let most: [f64; 3] = std::array::from_fn(most);
        let full = out.full_rate_rad_s;
        let base = out.vehicle.identified.as_ref().map_or("", |i| &i.base).to_string();
        let [r, p, y] = full.map(f64::to_degrees);
        let mut text = format!(
            "full-stick rates are those of {base} ({r:.0}, {p:.0}, {y:.0} deg/s): give --full-rates as they are \
             configured"
        );
        let beyond = (0..3).any(|k| most[k] > BEYOND_FULL_STICK.get() * full[k]);
        if beyond {
            let [r, p, y] = most.map(f64::to_degrees);
            text += &format!("; the log asks for more, up to {r:.0}, {p:.0}, {y:.0} deg/s");
        }
        out.remark(text);
    }
    if out.lent("mass_kg").is_some() && out.thrust.full_n.value.is_some() {
        let mass = out.vehicle.mass_kg;
        out.remark(format!("forces in newtons are those of a mass of {mass} kg, which is assumed: give --mass"));
    }
}
