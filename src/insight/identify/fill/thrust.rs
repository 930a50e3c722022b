//! Thrust: its lag, its curve, its drag.

use super::{judged, response};
use crate::base::stats::NORMAL_95;
use crate::insight::identify::estimate::Estimated;
use crate::insight::identify::fits::Fits;
use crate::insight::identify::force_terms::{DRAG_AT, TAU, THRUST};
use crate::insight::identify::judge::Accepted;
use crate::insight::identify::result::Identification;
use crate::insight::identify::solve::Solution;
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

/// What was found of the curve, `full` being its thrust at full command.
pub fn thrust(out: &mut Identification, all: &Fits, verdict: &Accepted, full: Estimated) {
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
pub fn drag(out: &mut Identification, all: &Fits, verdict: &Accepted) {
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
