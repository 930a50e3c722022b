//! From flight logs to a vehicle (paper section 4.1 and Table 1).
//!
//! Each part of the model is fitted on the first 70 % of the flight and validated on the rest; the values are then fitted
//! once more on all of it. What the logs cannot tell is taken from a base vehicle, and marked.

pub mod battery;
pub mod bias;
pub mod data;
pub mod document;
pub mod estimate;
pub mod flight;
pub mod force;
pub mod rates;
pub mod result;
pub mod solve;

use crate::check::{Check, Invalid};
use crate::dynamics::drag::ellipsoid;
use crate::flight::quality::Quality;
use crate::stats::quantile;
use crate::vehicle::{MaxRates, TimeConstants, Vehicle};
use data::{Data, Part};
use estimate::Estimate;
use force::{DRAG_AT, Force, TAU, THRUST, Terms};
use rates::Axis;
use result::{Channel, Identification, Response};
use serde::Deserialize;
use solve::Solution;

/// How to identify.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Options {
    /// Where values come from that the logs cannot tell.
    pub base: Vehicle,
    /// Mass, kg; none: what the logs say, else the base vehicle's.
    pub mass_kg: Option<f64>,
    /// Body rates that a full stick asks for, rad/s; none: what the logs say, else the base vehicle's.
    pub max_rate_rad_s: Option<[f64; 3]>,
    /// Cut-off of the zero-phase filter on rates, measured and predicted, Hz.
    pub rate_cutoff_hz: f64,
    /// The same for specific force.
    pub force_cutoff_hz: f64,
}

impl Check for Options {
    fn check(&self) -> Result<(), Invalid> {
        Invalid::unless_positive("--mass", self.mass_kg.unwrap_or(1.0), "")?;
        Invalid::unless_positive("--rate-cutoff", self.rate_cutoff_hz, "")?;
        Invalid::unless_positive("--force-cutoff", self.force_cutoff_hz, "")
    }
}

/// What identification is busy with: called before each step with its name and the share done so far.
pub type Watch<'a> = &'a mut dyn FnMut(&str, f64);

pub const AXES: [&str; 3] = ["roll", "pitch", "yaw"];

/// Identifies one vehicle from its flights.
pub fn identify(logs: Vec<Quality>, options: &Options, watch: Watch) -> Identification {
    let data = Data::new(logs);
    let mut out = Identification::new(&data, options);
    for (axis, name) in AXES.into_iter().enumerate() {
        watch(&format!("{name} response"), 0.15 * axis as f64);
        fit_rate(&data, axis, options, &mut out);
    }
    watch("battery", 0.45);
    fit_battery(&data, &mut out);
    watch("thrust and drag", 0.5);
    fit_force(&data, options, &mut out);
    watch("done", 1.0);
    out
}

/// Adds what a part of the data says about a missing delay: how late, and by how much the error falls.
const TELLING_DELAY_S: f64 = 0.003;
const TELLING_GAIN: f64 = 0.95;

fn fit_rate(data: &Data, axis: usize, options: &Options, out: &mut Identification) {
    let name = AXES[axis];
    let unknown = |why: &str, out: &mut Identification| {
        out.response[axis] = Response { tau_s: Estimate::unknown(why), ..Response::default() };
        out.max_rate_rad_s[axis] = Estimate::unknown(why);
        out.assume(&format!("time_constant_s.{name}"), why);
        out.assume(&format!("max_rate_deg_s.{name}"), why);
    };
    if let Some(why) = data.why_not(&format!("{name} response")) {
        return unknown(&why, out);
    }
    let rate = Axis::new(data, axis, options.rate_cutoff_hz);
    let (Some(train), Some(all)) = (rate.fit(Part::Train, false), rate.fit(Part::All, false)) else {
        return unknown("too few stretches of flight for a fit", out);
    };
    let degrees = 1f64.to_degrees();
    let validation = rate.compare(Part::Validation, &train);
    let score = validation.score();
    let full = out.full_rate_rad_s[axis];
    out.response[axis] = Response {
        tau_s: Estimate::of(&all, 0),
        offset: Estimate::of(&all, 2).times(degrees),
        rmse: Some(score.rmse * degrees),
        mae: Some(score.mae * degrees),
        r2: Some(score.r2),
        n_train: rate.compare(Part::Train, &train).measured.len(),
        n_validation: score.n,
        unit: "deg/s",
    };
    out.max_rate_rad_s[axis] = Estimate::of(&all, 1).times(full);
    let vehicle = &mut out.vehicle;
    let TimeConstants { roll, pitch, yaw, .. } = &mut vehicle.time_constant_s;
    *[roll, pitch, yaw][axis] = all.values[0];
    let MaxRates { roll, pitch, yaw } = &mut vehicle.max_rate_deg_s;
    *[roll, pitch, yaw][axis] = all.values[1] * full * degrees;
    out.remember(&format!("time_constant_s.{name}"), out.response[axis].tau_s.interval());
    out.remember(&format!("max_rate_deg_s.{name}"), out.max_rate_rad_s[axis].times(degrees).interval());
    if all.at_bound[0] {
        out.remark(format!(
            "{name}: the time constant ended at the bound of the search, {:.1} ms",
            1e3 * all.values[0]
        ));
    }
    if let Some(late) = rate.fit(Part::Train, true) {
        let better = rate.compare(Part::Validation, &late).score();
        if late.values[3] > TELLING_DELAY_S && better.rmse < TELLING_GAIN * score.rmse {
            out.remark(format!(
                "{name}: a pure delay of {:.0} ms before a lag of {:.0} ms would bring R2 from {:.3} to {:.3}; the model has none",
                1e3 * late.values[3],
                1e3 * late.values[0],
                score.r2,
                better.r2
            ));
        }
    }
    out.channels.push(Channel::new(
        &format!("{name} rate"),
        "deg/s",
        degrees,
        &rate.compare(Part::Train, &train),
        &validation,
    ));
}

fn fit_battery(data: &Data, out: &mut Identification) {
    let unknown = |why: String, out: &mut Identification| {
        out.battery.initial_v = Estimate::unknown(&why);
        out.battery.rate_v_s = Estimate::unknown(&why);
        out.assume("battery", &why);
    };
    if let Some(why) = data.why_not("battery") {
        return unknown(why, out);
    }
    let (Some(train), Some(all)) = (battery::fit(data, Part::Train), battery::fit(data, Part::All)) else {
        return unknown("too few stretches of flight for a fit".into(), out);
    };
    let validation = battery::compare(data, Part::Validation, &train);
    out.battery.initial_v = Estimate::of(&all, battery::INITIAL);
    out.battery.rate_v_s = Estimate::of(&all, battery::RATE);
    let whole = battery::compare(data, Part::All, &all);
    let lowest = whole.predicted.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = all.values[battery::INITIAL..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let base = out.vehicle.battery;
    let battery = &mut out.vehicle.battery;
    battery.full_v = highest;
    // As far as it was flown, and at least as far as the base vehicle flies its own pack.
    battery.empty_v = lowest.min(highest * base.empty_v / base.full_v);
    battery.rate_v_s = all.values[battery::RATE].min(0.0);
    if all.values[battery::RATE] > 0.0 {
        out.remark("battery: the voltage rises in flight; the vehicle file says that it stays".into());
    }
    out.remember("battery.full_v", out.battery.initial_v.interval());
    out.remember("battery.rate_v_s", out.battery.rate_v_s.interval());
    let train = battery::compare(data, Part::Train, &train);
    out.battery.score = Some(validation.score());
    out.channels.push(Channel::new("voltage", "V", 1.0, &train, &validation));
}

fn fit_force(data: &Data, options: &Options, out: &mut Identification) {
    if let Some(why) = data.why_not("thrust curve") {
        out.response[3] = Response { tau_s: Estimate::unknown(&why), ..Response::default() };
        out.thrust_n = [const { () }; 6].map(|()| Estimate::unknown(&why));
        out.drag.unknown(&why);
        out.assume("time_constant_s.thrust", &why);
        out.assume("thrust_n", &why);
        return out.assume("drag", &why);
    }
    let (no_voltage, no_drag) = (data.why_not("thrust over voltage"), data.why_not("drag"));
    let gravity = out.vehicle.gravity_m_s2;
    let bias = bias::fit(data, gravity);
    let taken_off = bias.as_ref().map_or([0.0; 3], |b| [0.0, 0.0, b.values[2]]);
    let moving = data.flights.iter().any(|flight| flight.velocity[0].iter().any(|v| v.is_finite()));
    let given = if no_drag.is_some() && moving {
        ellipsoid(&out.vehicle.drag).map(|k| k / out.vehicle.mass_kg)
    } else {
        [0.0; 3]
    };
    let voltage = no_voltage.is_none();
    // The whole cubic, then less of it where the flown range does not settle its shape.
    let curves = [[true; 4], [true, true, true, false], [true, true, false, false]];
    let mut tried = Vec::new();
    for curve in curves {
        let terms =
            Terms { thrust: [curve[0], curve[1], curve[2], curve[3], voltage, voltage], drag: no_drag.is_none() };
        let force = Force::new(data, terms, taken_off, given, options.force_cutoff_hz);
        let Some(all) = force.fit(Part::All, None) else { continue };
        let mut vehicle = out.vehicle.clone();
        vehicle.thrust_n = std::array::from_fn(|k| all.values[THRUST + k] * vehicle.mass_kg);
        let trouble = vehicle.check_thrust().err();
        let fine = trouble.is_none();
        tried.push((force, all, terms, trouble));
        if fine {
            break;
        }
    }
    let Some((force, all, terms, trouble)) = tried.pop() else {
        let why = "too few stretches of flight for a fit";
        out.response[3].tau_s = Estimate::unknown(why);
        out.drag.unknown(why);
        out.assume("time_constant_s.thrust", why);
        out.assume("thrust_n", why);
        return out.assume("drag", why);
    };
    if let Some((.., Some(first))) = tried.first().map(|(a, b, c, d)| (a, b, c, d)) {
        let kept = terms.thrust[..4].iter().filter(|&&kept| kept).count() - 1;
        out.remark(format!("thrust: the whole cubic has {}; fitted with the powers up to {kept}", first.found));
    }
    keep_thrust(&force, &all, bias.as_ref(), trouble, out);
    keep_drag(&all, no_drag, out);
    if let Some(why) = no_voltage {
        out.thrust_n[4] = Estimate::unknown(&why);
        out.thrust_n[5] = Estimate::unknown(&why);
        out.remark(format!("thrust over voltage: {why}; c4 = c5 = 0"));
    }
    validate_force(&force, &all, bias.as_ref(), out);
}

fn keep_thrust(
    force: &Force,
    all: &Solution,
    bias: Option<&Solution>,
    trouble: Option<Invalid>,
    out: &mut Identification,
) {
    let mass = out.vehicle.mass_kg;
    out.flown = Some(force.flown(all.values[TAU]));
    out.response[3].tau_s = Estimate::of(all, TAU);
    out.thrust_n = std::array::from_fn(|k| Estimate::of(all, THRUST + k).times(mass));
    // c0 takes over what is uncertain about the accelerometer's bias.
    let c0 = &mut out.thrust_n[0];
    if let (Some(bias), Some(value), Some(high)) = (bias, c0.value, c0.high) {
        *c0 = Estimate::new(value, (high - value).hypot(bias.half_width(2) * mass));
    }
    out.vehicle.time_constant_s.thrust = all.values[TAU];
    let thrust = std::array::from_fn(|k| all.values[THRUST + k] * mass);
    match trouble {
        None => out.vehicle.thrust_n = thrust,
        Some(trouble) => {
            let why = format!("the fitted curve has {}: a longer log with more throttle is needed", trouble.found);
            out.assume("thrust_n", &why);
            out.remark(format!("thrust: {why}"));
        }
    }
    for k in 0..6 {
        out.remember(&format!("thrust_n[{k}]"), out.thrust_n[k].interval());
    }
    out.remember("time_constant_s.thrust", out.response[3].tau_s.interval());
    if all.at_bound[TAU] {
        let tau = 1e3 * all.values[TAU];
        out.remark(format!("thrust: the time constant ended at the bound of the search, {tau:.1} ms"));
    }
    match bias {
        Some(bias) => out.accelerometer_bias_m_s2 = [0, 1, 2].map(|k| Estimate::of(bias, k)),
        None => {
            let why = "no odometry fast enough to tell it from thrust; c0 contains it";
            out.accelerometer_bias_m_s2 = [const { () }; 3].map(|()| Estimate::unknown(why));
        }
    }
}

/// The logs tell three numbers, drag over mass along each axis; four make the ellipsoid. The coefficient stays the base
/// vehicle's, and the semi-axes follow.
fn keep_drag(all: &Solution, no_drag: Option<String>, out: &mut Identification) {
    if let Some(why) = no_drag {
        out.drag.unknown(&why);
        return out.assume("drag", &why);
    }
    let k: [f64; 3] = std::array::from_fn(|i| all.values[DRAG_AT + i]);
    out.drag.k_1_m = [0, 1, 2].map(|i| Estimate::of(all, DRAG_AT + i));
    for (axis, estimate) in ["x", "y", "z"].iter().zip(out.drag.k_1_m.clone()) {
        if estimate.low.is_none() {
            out.remark(format!("drag along {axis} ended at the bound of the search"));
        }
        out.remember(&format!("drag_over_mass_1_m.{axis}"), estimate.interval());
    }
    // A semi-axis of zero would be no ellipsoid.
    let least = 1e-2 * k.iter().copied().fold(1e-4, f64::max);
    let drag = &mut out.vehicle.drag;
    let unit = 0.5 * drag.air_density_kg_m3 * drag.coefficient * std::f64::consts::PI / out.vehicle.mass_kg;
    let [x, y, z] = k.map(|k| k.max(least) / unit);
    drag.semi_axes_m = [(y * z / x).sqrt(), (x * z / y).sqrt(), (x * y / z).sqrt()];
    out.drag.semi_axes_m = Some(drag.semi_axes_m);
    out.drag.coefficient = Some(drag.coefficient);
    out.assume("drag.coefficient", "the size of the body and its coefficient act alike; the semi-axes follow from it");
}

fn validate_force(force: &Force, all: &Solution, bias: Option<&Solution>, out: &mut Identification) {
    let Some(train) = force.fit(Part::Train, Some(all)) else {
        return out.remark("thrust: the training part alone is too short; no validation".into());
    };
    let shown: &[usize] = if out.drag.k_1_m[0].value.is_some() { &[2, 0, 1] } else { &[2] };
    for &k in shown {
        let (learned, validation) = (force.compare(Part::Train, &train, k), force.compare(Part::Validation, &train, k));
        let score = validation.score();
        if k == 2 {
            out.response[3] = Response {
                tau_s: out.response[3].tau_s.clone(),
                offset: bias.map_or_else(Estimate::default, |bias| Estimate::of(bias, 2)),
                rmse: Some(score.rmse),
                mae: Some(score.mae),
                r2: Some(score.r2),
                n_train: learned.measured.len(),
                n_validation: score.n,
                unit: "m/s2",
            };
        }
        let name = format!("specific force {}", ["x", "y", "z"][k]);
        out.channels.push(Channel::new(&name, "m/s2", 1.0, &learned, &validation));
    }
    if out.drag.k_1_m[0].value.is_some() {
        let v = out.fastest_m_s;
        out.drag.flown_m_s = v;
    }
}

/// 99 % of the speed in flight, m/s; none without velocity.
fn fastest(data: &Data) -> Option<f64> {
    let mut speeds = Vec::new();
    for flight in &data.flights {
        for i in (0..flight.time.len()).filter(|&i| flight.usable[i]) {
            speeds.push((0..3).map(|k| flight.velocity[k][i].powi(2)).sum::<f64>().sqrt());
        }
    }
    speeds.retain(|v| v.is_finite());
    (!speeds.is_empty()).then(|| quantile(&speeds, 0.99))
}
