//! Rate axes: lag, maximum rate, and where a pure delay would do better.

use super::{judged, response};
use crate::insight::criteria::shown::{REMARKED_DELAY_S, REMARKED_ERROR, REMARKED_R2};
use crate::insight::identify::IdentifyOptions;
use crate::insight::identify::estimate::Estimated;
use crate::insight::identify::fits::Fits;
use crate::insight::identify::judge::Accepted;
use crate::insight::identify::rates::{BesideLag, DELAY, LookedFor, RateAxis};
use crate::insight::identify::result::{Identification, Response};
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::vehicle::AXES;

/// What was found of an axis.
pub fn rate(
    out: &mut Identification,
    data: &Data,
    axis: usize,
    all: &Fits,
    verdict: &Accepted,
    options: &IdentifyOptions,
) {
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
            let why = "the log tells its share of the full-stick rate, and that is assumed: give --full-rates";
            out.assume(&rate_key, why);
        } else {
            out.found(&rate_key, out.max_rate_rad_s[axis].times(degrees).interval());
        }
    }
    delay(out, data, axis, all, options);
}

/// Says where a pure delay would predict a rate better than the lag alone.
fn delay(out: &mut Identification, data: &Data, axis: usize, all: &Fits, options: &IdentifyOptions) {
    let response = &out.response[axis];
    if !all.rate_loop.parts().is_empty() || response.r2.is_none_or(|r2| r2 >= REMARKED_R2.get()) {
        return;
    }
    let rate = RateAxis::new(data, axis, options.rate_cutoff_hz);
    let none = BesideLag::default();
    let fits = [LookedFor::Nothing, LookedFor::Delay].map(|look| rate.fit(DataPart::Train, none, look));
    let [Some(plain), Some(late)] = fits else { return };
    let delayed = BesideLag { delay: late.values[DELAY], ..none };
    let [plain, better] =
        [(&plain, none), (&late, delayed)].map(|(fit, beside)| rate.score(DataPart::Validation, fit, beside));
    if late.values[DELAY] > REMARKED_DELAY_S.get() && better.rmse < REMARKED_ERROR.get() * plain.rmse {
        out.remark(format!(
            "{}: a pure delay of {:.0} ms before a lag of {:.0} ms would bring R2 from {:.3} to {:.3}; not told of \
             the other axes, it is no part of the vehicle",
            AXES[axis],
            1e3 * late.values[DELAY],
            1e3 * late.values[0],
            plain.r2,
            better.r2
        ));
    }
}
