//! Which fitted numbers a vehicle takes: those that predict flight they have not seen, that lie within the search, and
//! that the flight tells at all. The others are left to the base vehicle, with the reason.

use super::estimate::Estimated;
use super::fits::{Fits, Kept};
use super::force_terms::{DRAG_AT, TAU};
use crate::base::stats::Score;
use crate::insight::criteria::identified::UNEXPLAINED_MOST;
use crate::insight::predict::{PredictedChannel, Prediction};
use crate::model::vehicle::AXES;
use std::collections::BTreeMap;

/// What is kept, and why the rest is not, by the key of a vehicle file.
pub struct Accepted {
    pub kept: Kept,
    pub left: BTreeMap<String, String>,
}

/// Why a fit with this score does not predict.
pub fn unpredictive(score: Option<Score>) -> Option<String> {
    let score = score?;
    let poor = score.r2.is_nan() || 1.0 - score.r2 >= UNEXPLAINED_MOST.get();
    poor.then(|| format!("it does not predict: R2 {:.2} on the validation part", score.r2))
}

/// The validation score of a channel.
pub fn score(validation: &Prediction, name: &str) -> Option<Score> {
    let channel: &PredictedChannel = validation.channels.iter().find(|channel| channel.name == name)?;
    Some(channel.score(0))
}

/// Judges the fits to all of the flights by how those to the training part predict the rest. `flown` is the thrust at
/// the highest command that was flown.
pub fn judge(all: &Fits, validation: &Prediction, flown: &Estimated) -> Accepted {
    let mut out = Accepted { kept: all.everything(), left: BTreeMap::new() };
    for axis in 0..3 {
        rate(axis, all, validation, &mut out);
    }
    battery(all, validation, &mut out);
    thrust(all, validation, flown, &mut out);
    drag(all, validation, &mut out);
    // A pack and the thrust over its voltage are of one vehicle, or the base's own.
    if !out.kept.thrust && out.kept.volts {
        (out.kept.volts, out.kept.discharge) = (false, false);
        out.leave("battery", "it belongs to the thrust curve, which is the base vehicle's".into());
    }
    out
}

impl Accepted {
    fn leave(&mut self, key: &str, why: String) {
        self.left.insert(key.into(), why);
    }
}

fn rate(axis: usize, all: &Fits, validation: &Prediction, out: &mut Accepted) {
    let name = AXES[axis];
    let (lag_key, rate_key) = (format!("time_constant_s.{name}"), format!("max_rate_deg_s.{name}"));
    let both = match &all.rates[axis] {
        Err(why) => Some(why.clone()),
        Ok(_) => unpredictive(score(validation, &format!("{name} rate"))),
    };
    if let Some(why) = both {
        (out.kept.lag[axis], out.kept.rate[axis]) = (false, false);
        out.leave(&lag_key, why.clone());
        return out.leave(&rate_key, why);
    }
    let Ok(fit) = &all.rates[axis] else { return };
    if let Some(why) = Estimated::of(fit, 0).vague() {
        out.kept.lag[axis] = false;
        out.leave(&lag_key, why);
    }
    if let Some(why) = Estimated::of(fit, 1).vague() {
        out.kept.rate[axis] = false;
        out.leave(&rate_key, why);
    }
}

fn battery(all: &Fits, validation: &Prediction, out: &mut Accepted) {
    let fit = match &all.battery {
        Err(why) => return out.leave("battery", why.clone()),
        Ok(fit) => fit,
    };
    let rate = Estimated::of(fit, super::battery::RATE);
    let rises = rate.value.is_some_and(|rate| rate > 0.0).then(|| "the voltage rises in flight".to_string());
    let why = rises.or_else(|| unpredictive(score(validation, "voltage"))).or_else(|| rate.vague());
    if let Some(why) = why {
        out.kept.discharge = false;
        out.leave("battery.rate_v_s", format!("{why}; the base vehicle's, in proportion to the voltage"));
    }
}

fn thrust(all: &Fits, validation: &Prediction, flown: &Estimated, out: &mut Accepted) {
    let fit = match &all.thrust {
        Err(why) => {
            ["time_constant_s.thrust", "thrust_n"].into_iter().for_each(|key| out.leave(key, why.clone()));
            return;
        }
        Ok(fit) => fit,
    };
    if let Some(why) = unpredictive(score(validation, "specific force z")).or_else(|| flown.vague()) {
        (out.kept.thrust, out.kept.lag[3]) = (false, false);
        out.leave("thrust_n", why.clone());
        return out.leave("time_constant_s.thrust", why);
    }
    if !fit.lags {
        return out.leave("time_constant_s.thrust", "the log has rotor speeds and no command that they follow".into());
    }
    // Of a chain, the rotors' own lag is the one that is looked for.
    let lag = Estimated::of(fit.motors.as_ref().unwrap_or(&fit.solution), TAU);
    if let Some(why) = lag.vague() {
        out.kept.lag[3] = false;
        out.leave("time_constant_s.thrust", why);
    }
}

fn drag(all: &Fits, validation: &Prediction, out: &mut Accepted) {
    let why = match (&all.no_drag, &all.thrust) {
        (Some(why), _) | (None, Err(why)) => Some(why.clone()),
        (None, Ok(_)) if !out.kept.thrust => Some("it was fitted with the thrust, which is not kept".into()),
        (None, Ok(fit)) => {
            let across = ["specific force x", "specific force y"].map(|name| unpredictive(score(validation, name)));
            let largest =
                (0..3).map(|k| DRAG_AT + k).max_by(|&a, &b| fit.solution.values[a].total_cmp(&fit.solution.values[b]));
            let largest = largest.and_then(|k| Estimated::of(&fit.solution, k).vague());
            match across {
                [Some(why), Some(_)] => Some(why),
                _ => largest,
            }
        }
    };
    if let Some(why) = why {
        out.kept.drag = false;
        out.leave("drag", why);
    }
}
