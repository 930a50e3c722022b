//! Thrust and drag, into the result.

use crate::base::check::Invalid;
use crate::insight::identify::estimate::Estimate;
use crate::insight::identify::force::{DRAG_AT, Force, TAU, THRUST, Terms};
use crate::insight::identify::result::{ComparedChannel, Identification, Response};
use crate::insight::identify::solve::Solution;
use crate::insight::identify::{IdentifyOptions, bias};
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::dynamics::drag::{ellipsoid, semi_axes};

/// A thrust curve that was fitted.
struct Curve<'a> {
    force: Force<'a>,
    all: Solution,
    /// Its highest power.
    power: usize,
    /// Why no vehicle has such a curve.
    trouble: Option<Invalid>,
}

/// Fits the thrust curve with as many powers as the flight settles, its time constant, and the drag.
pub fn report(data: &Data, options: &IdentifyOptions, out: &mut Identification) {
    if let Some(why) = data.why_not("thrust curve") {
        return unknown(&why, out);
    }
    let no_drag = data.why_not("drag");
    let bias = bias::fit(data, out.vehicle.gravity_m_s2);
    let mut tried = curves(data, bias.as_ref(), options, out);
    let Some(Curve { force, all, power, trouble }) = tried.pop() else {
        return unknown("too few stretches of flight for a fit", out);
    };
    if let Some(first) = tried.first().and_then(|first| first.trouble.as_ref()) {
        out.remark(format!("thrust: the whole cubic has {}; fitted with the powers up to {power}", first.found));
    }
    keep_thrust(&force, &all, bias.as_ref(), trouble, out);
    keep_drag(&all, no_drag, out);
    if let Some(why) = data.why_not("thrust over voltage") {
        out.thrust_n[4] = Estimate::unknown(&why);
        out.thrust_n[5] = Estimate::unknown(&why);
        out.remark(format!("thrust over voltage: {why}; c4 = c5 = 0"));
    }
    validate_force(&force, &all, bias.as_ref(), out);
}

/// Neither thrust nor drag is told.
fn unknown(why: &str, out: &mut Identification) {
    out.response[3].tau_s = Estimate::unknown(why);
    out.thrust_n = std::array::from_fn(|_| Estimate::unknown(why));
    out.drag.unknown(why);
    ["time_constant_s.thrust", "thrust_n", "drag"].into_iter().for_each(|key| out.assume(key, why));
}

/// The whole cubic, then less of it where the flown range does not settle its shape; the last is the one to take.
fn curves<'a>(
    data: &'a Data,
    bias: Option<&Solution>,
    options: &IdentifyOptions,
    out: &Identification,
) -> Vec<Curve<'a>> {
    let drag = data.why_not("drag").is_none();
    let voltage = data.why_not("thrust over voltage").is_none();
    let moving = data.flights.iter().any(|flight| flight.velocity[0].iter().any(|v| v.is_finite()));
    let base = ellipsoid(&out.vehicle.drag).map(|k| k / out.vehicle.mass_kg);
    let given = if !drag && moving { base } else { [0.0; 3] };
    let bias = bias.map_or([0.0; 3], |b| [0.0, 0.0, b.values[2]]);
    let mut tried = Vec::new();
    for power in [3, 2, 1] {
        let terms = Terms { thrust: std::array::from_fn(|k| if k < 4 { k <= power } else { voltage }), drag };
        let force = Force::new(data, terms, bias, given, options.force_cutoff_hz);
        let Some(all) = force.fit(DataPart::All, None) else { continue };
        let mut vehicle = out.vehicle.clone();
        vehicle.thrust_n = std::array::from_fn(|k| all.values[THRUST + k] * vehicle.mass_kg);
        let trouble = vehicle.check_thrust().err();
        let fine = trouble.is_none();
        tried.push(Curve { force, all, power, trouble });
        if fine {
            break;
        }
    }
    tried
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
            out.accelerometer_bias_m_s2 = std::array::from_fn(|_| Estimate::unknown(why));
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
    let k = k.map(|k| k.max(least) * out.vehicle.mass_kg);
    drag.semi_axes_m = semi_axes(k, drag.coefficient, drag.air_density_kg_m3);
    out.drag.semi_axes_m = Some(drag.semi_axes_m);
    out.drag.coefficient = Some(drag.coefficient);
    out.assume("drag.coefficient", "the size of the body and its coefficient act alike; the semi-axes follow from it");
}

fn validate_force(force: &Force, all: &Solution, bias: Option<&Solution>, out: &mut Identification) {
    let Some(train) = force.fit(DataPart::Train, Some(all)) else {
        return out.remark("thrust: the training part alone is too short; no validation".into());
    };
    let shown: &[usize] = if out.drag.k_1_m[0].value.is_some() { &[2, 0, 1] } else { &[2] };
    for &k in shown {
        let (learned, validation) =
            (force.compare(DataPart::Train, &train, k), force.compare(DataPart::Validation, &train, k));
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
        out.channels.push(ComparedChannel::new(&name, "m/s2", 1.0, &learned, &validation));
    }
    if out.drag.k_1_m[0].value.is_some() {
        out.drag.flown_m_s = out.fastest_m_s;
    }
}
