//! The response of one rate axis, into the result.

use crate::insight::criteria::shown::{REMARKED_DELAY_S, REMARKED_ERROR, REMARKED_R2};
use crate::insight::identify::estimate::Estimate;
use crate::insight::identify::rates::{Compared, RateAxis};
use crate::insight::identify::result::{ComparedChannel, Identification, Response};
use crate::insight::identify::solve::Solution;
use crate::insight::identify::{AXES, IdentifyOptions};
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::vehicle::{MaxRates, TimeConstants};

/// One axis, fitted on the training part, on all of it, and with a delay where one may be missing.
pub struct Fitted<'a> {
    rate: RateAxis<'a>,
    train: Solution,
    all: Solution,
    validation: Compared,
    late: Option<Solution>,
}

/// Fits `axis` (0 roll, 1 pitch, 2 yaw), or says why the logs cannot tell it.
pub fn fit<'a>(data: &'a Data, axis: usize, options: &IdentifyOptions) -> Result<Fitted<'a>, String> {
    if let Some(why) = data.why_not(&format!("{} response", AXES[axis])) {
        return Err(why);
    }
    let rate = RateAxis::new(data, axis, options.rate_cutoff_hz);
    let (Some(train), Some(all)) = (rate.fit(DataPart::Train, false), rate.fit(DataPart::All, false)) else {
        return Err("too few stretches of flight for a fit".into());
    };
    let validation = rate.compare(DataPart::Validation, &train);
    let late = if validation.score().r2 < REMARKED_R2.get() { rate.fit(DataPart::Train, true) } else { None };
    Ok(Fitted { rate, train, all, validation, late })
}

/// Puts what was found about `axis` into the result.
pub fn keep(fitted: Result<Fitted, String>, axis: usize, out: &mut Identification) {
    let name = AXES[axis];
    let Fitted { rate, train, all, validation, late } = match fitted {
        Ok(fitted) => fitted,
        Err(why) => {
            out.response[axis] = Response { tau_s: Estimate::unknown(&why), ..Response::default() };
            out.max_rate_rad_s[axis] = Estimate::unknown(&why);
            out.assume(&format!("time_constant_s.{name}"), &why);
            return out.assume(&format!("max_rate_deg_s.{name}"), &why);
        }
    };
    let degrees = 1f64.to_degrees();
    let score = validation.score();
    let full = out.full_rate_rad_s[axis];
    out.response[axis] = Response {
        tau_s: Estimate::of(&all, 0),
        offset: Estimate::of(&all, 2).times(degrees),
        rmse: Some(score.rmse * degrees),
        mae: Some(score.mae * degrees),
        r2: Some(score.r2),
        n_train: rate.compare(DataPart::Train, &train).measured.len(),
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
    if let Some(late) = late {
        let better = rate.compare(DataPart::Validation, &late).score();
        if late.values[3] > REMARKED_DELAY_S.get() && better.rmse < REMARKED_ERROR.get() * score.rmse {
            out.remark(format!(
                "{name}: a pure delay of {:.0} ms before a lag of {:.0} ms \
                would bring R2 from {:.3} to {:.3}; the model has none",
                1e3 * late.values[3],
                1e3 * late.values[0],
                score.r2,
                better.r2
            ));
        }
    }
    out.channels.push(ComparedChannel::new(
        &format!("{name} rate"),
        "deg/s",
        degrees,
        &rate.compare(DataPart::Train, &train),
        &validation,
    ));
}
