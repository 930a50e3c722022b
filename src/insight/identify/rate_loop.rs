//! What a flight controller's rate loop has beside a lag on each axis: a delay and a largest angular acceleration for
//! all axes, or a second order, and yaw later by its own, or of second order by its own. A vehicle has them where
//! flight that was not used for fitting is clearly better predicted with them.

use super::estimate::Estimated;
use super::rates::{BesideLag, DELAY, INERTIA, LookedFor, RateAxis, SLEW};
use super::solve::Solution;
use crate::base::stats::Score;
use crate::insight::criteria::shown::{REMARKED_DELAY_S, REMARKED_ERROR, REMARKED_R2};
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::effects::{ControllerPart, YAW_SLEW_SHARE, of_controller};
use crate::model::vehicle::AXES;
use rayon::prelude::*;

/// The axes that share what they have; yaw comes from reaction torque.
const SHARING: [usize; 2] = [0, 1];
const YAW: usize = 2;
/// Share of the error that the best start of a fit leaves, from which the fit is not tried.
const WORTH_A_FIT: f64 = 0.99;

/// Which parts of it are looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RateLoopForm {
    /// Of all axes.
    pub all: LookedFor,
    /// Of yaw alone: a delay or a second order.
    pub yaw: LookedFor,
}

/// A rate loop; what is not looked for has no value.
#[derive(Clone, Debug, Default)]
pub struct RateLoop {
    /// Delay of all axes, s.
    pub delay_s: Estimated,
    /// By how much more yaw is delayed, s.
    pub yaw_extra_s: Estimated,
    /// T2 of the second order of all axes, s2.
    pub inertia_s2: Estimated,
    /// What yaw has of it beyond that, s2.
    pub yaw_inertia_s2: Estimated,
    /// One over the largest angular acceleration of roll and pitch, s2/rad.
    pub slew_s2_rad: Estimated,
}

/// The form that predicts: each part has to be told, and to lower the error on the validation part.
pub fn form(data: &Data, cutoff_hz: f64) -> RateLoopForm {
    let mut form = RateLoopForm::default();
    let told = |axis: usize| data.why_not(&format!("{} response", AXES[axis])).is_none();
    if !(0..3).all(told) {
        return form;
    }
    let axes = [0, 1, 2].map(|axis| RateAxis::new(data, axis, cutoff_hz));
    let Some(plain) = errors(&axes, &RateLoop::default()) else { return form };
    if plain.iter().all(|(_, error)| error.r2 >= REMARKED_R2.get()) {
        return form;
    }
    let promising = |axis: &usize, look: LookedFor| {
        let promise = axes[*axis].promise(DataPart::Train, &plain[*axis].0, look);
        promise.is_some_and(|share| share < WORTH_A_FIT)
    };
    let mut best = plain.each_ref().map(|(_, error)| error.rmse);
    let shares = |now: &[f64; 3], best: &[f64; 3], which: &[usize]| {
        let squares: f64 = which.iter().map(|&axis| (now[axis] / best[axis]).powi(2)).sum();
        (squares / which.len() as f64).sqrt()
    };
    let tried = |wanted: RateLoopForm| {
        let found = fit(&axes, DataPart::Train, wanted)?;
        Some(errors(&axes, &found)?.map(|(_, error)| error.rmse))
    };
    // The more numbers a form has, the later it is tried: each has to be clearly better than those before.
    for all in [LookedFor::Delay, LookedFor::SecondOrder, LookedFor::DelayAndLimit] {
        let wanted = RateLoopForm { all, ..form };
        if !SHARING.par_iter().any(|axis| promising(axis, all)) {
            continue;
        }
        if let Some(now) = tried(wanted).filter(|now| shares(now, &best, &SHARING) < REMARKED_ERROR.get()) {
            (best, form) = (now, wanted);
        }
    }
    let yaw = [LookedFor::Delay, LookedFor::SecondOrder].into_iter();
    let yaw = yaw.filter(|look| form.all != LookedFor::Nothing || promising(&YAW, *look));
    let yaw = yaw
        .map(|yaw| RateLoopForm { yaw, ..form })
        .filter_map(|wanted| Some((tried(wanted)?[YAW] / best[YAW], wanted)));
    let best = yaw.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(share, _)| *share < REMARKED_ERROR.get());
    best.map_or(form, |(_, wanted)| wanted)
}

/// Each axis fitted to the training part with this loop, and its score on the validation part.
fn errors(axes: &[RateAxis; 3], found: &RateLoop) -> Option<[(Solution, Score); 3]> {
    let one = |axis: usize| {
        let beside = found.beside(axis);
        let fit = axes[axis].fit(DataPart::Train, beside, LookedFor::Nothing)?;
        let score = axes[axis].score(DataPart::Validation, &fit, beside);
        Some((fit, score))
    };
    let all: Option<Vec<_>> = (0..3).into_par_iter().map(one).collect();
    all?.try_into().ok()
}

/// Fits the parts of `form` to `part` of the flights. None where one of them is not told: a lag is not fitted beside
/// what no vehicle gets.
pub fn fit(axes: &[RateAxis; 3], part: DataPart, form: RateLoopForm) -> Option<RateLoop> {
    let mut out = RateLoop::default();
    if form.all != LookedFor::Nothing {
        let one = |axis: usize| axes[axis].fit(part, BesideLag::default(), form.all);
        let fits: Option<Vec<Solution>> = SHARING.into_par_iter().map(one).collect();
        let fits = fits?;
        match form.all {
            LookedFor::SecondOrder => out.inertia_s2 = shared(&fits, INERTIA),
            _ => out.delay_s = shared(&fits, DELAY),
        }
        if form.all == LookedFor::DelayAndLimit {
            out.slew_s2_rad = shared(&fits, SLEW);
        }
    }
    if form.yaw != LookedFor::Nothing {
        let own = axes[YAW].fit(part, out.beside(YAW), form.yaw)?;
        match form.yaw {
            LookedFor::SecondOrder => {
                out.yaw_inertia_s2 = Estimated::of(&own, INERTIA).less(out.inertia_s2.value.unwrap_or(0.0));
            }
            _ => out.yaw_extra_s = Estimated::of(&own, DELAY).less(out.delay_s.value.unwrap_or(0.0)),
        }
    }
    out.told().then_some(out)
}

/// Value `i` of both fits by their precision; its interval holds their difference.
fn shared(fits: &[Solution], i: usize) -> Estimated {
    if fits.iter().all(|fit| fit.at_bound[i]) {
        return Estimated::of(&fits[0], i);
    }
    let told: Vec<&Solution> = fits.iter().filter(|fit| !fit.at_bound[i]).collect();
    let weight = |fit: &Solution| fit.half_width(i).max(1e-9).powi(-2);
    let sum: f64 = told.iter().map(|fit| weight(fit)).sum();
    let value = told.iter().map(|fit| weight(fit) * fit.values[i]).sum::<f64>() / sum;
    let apart = told.iter().map(|fit| (fit.values[i] - value).abs()).fold(0.0, f64::max);
    Estimated::new(value, sum.powf(-0.5).max(apart))
}

impl RateLoop {
    /// Whether each part is told by the flight, and a delay one that matters.
    fn told(&self) -> bool {
        let delays = [&self.delay_s, &self.yaw_extra_s];
        let possible = |part: ControllerPart, size: &Estimated| {
            let bounds = of_controller(part).map(|card| &card.parameters[0]);
            bounds.zip(size.value).is_some_and(|(p, value)| (p.low..=p.high).contains(&value))
        };
        self.parts().iter().all(|(part, size)| size.vague().is_none() && possible(*part, size))
            && delays.iter().filter_map(|delay| delay.value).all(|delay| delay.abs() > REMARKED_DELAY_S.get())
    }

    /// What this axis has beside its lag.
    pub fn beside(&self, axis: usize) -> BesideLag {
        let size = |estimate: &Estimated| estimate.value.unwrap_or(0.0);
        let (delay, slew, inertia) = (size(&self.delay_s), size(&self.slew_s2_rad), size(&self.inertia_s2));
        if axis == YAW {
            let delay = (delay + size(&self.yaw_extra_s)).max(0.0);
            BesideLag { delay, slew: slew / YAW_SLEW_SHARE, inertia: inertia + size(&self.yaw_inertia_s2) }
        } else {
            BesideLag { delay, slew, inertia }
        }
    }

    /// What there is of it.
    pub fn parts(&self) -> Vec<(ControllerPart, &Estimated)> {
        let all = [
            (ControllerPart::Delay, &self.delay_s),
            (ControllerPart::YawDelay, &self.yaw_extra_s),
            (ControllerPart::Inertia, &self.inertia_s2),
            (ControllerPart::YawInertia, &self.yaw_inertia_s2),
            (ControllerPart::Slew, &self.slew_s2_rad),
        ];
        all.into_iter().filter(|(_, size)| size.value.is_some()).collect()
    }
}
