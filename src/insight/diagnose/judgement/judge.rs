//! From the fit to findings: evidence, replication, size and what is left.

use super::finding::{Finding, Status};
use super::impact::impact;
use super::replication::stretches;
use super::shown::parameters;
use crate::base::stats::mean;
use crate::insight::criteria::evident::EXPLAINS_ANYTHING;
use crate::insight::criteria::replicated::AGREEING_STRETCHES;
use crate::insight::diagnose::fitting::size::{is_bounded, is_material};
use crate::insight::diagnose::prediction::channels::{CHANNELS, NAMES, kind};
use crate::insight::diagnose::prediction::numbers::span;
use crate::insight::diagnose::prediction::problem::ChannelValues;
use crate::insight::diagnose::selection::Added;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::estimate::gram::Grams;
use crate::insight::estimate::inverse::inverse;
use crate::model::effects::Card;
use std::collections::BTreeMap;

/// A judged effect, and the numbers of the model without it.
pub struct Judged {
    pub finding: Finding,
    pub material: bool,
    /// Whether a number of it ends at the bound of its range.
    pub bounded: bool,
    /// How the fitted numbers move where the effect is left out.
    pub change: Vec<f64>,
}

/// Judges one added effect.
pub fn judge(fitted: &FittedSelection, added: &Added) -> Judged {
    let card = added.card;
    let (x, change) = without(fitted, card);
    let point = fitted.point();
    let replicated = stretches(fitted, card);
    let Explained { shares: explained, channel, elsewhere } = explained(fitted, card, &change);
    let doubt = if replicated.count < AGREEING_STRETCHES.get() && !replicated.evident() {
        Some(format!("only {:.0} stretches of flight agree", replicated.count))
    } else if !replicated.evident() {
        Some("its size is not sure enough".into())
    } else {
        // What the base does better beside it may be an error of the base.
        (elsewhere && explained.is_empty()).then(|| "all that it explains is in what it does not change".into())
    };
    let of_no_size = || (!replicated.sized()).then(|| "each visit shows another size".into());
    let why = doubt.clone().or_else(of_no_size);
    let finding = Finding {
        status: match (&doubt, added.ties.is_empty()) {
            (Some(_), _) => Status::Suspected,
            (None, true) => Status::Named,
            (None, false) => Status::NamedSet,
        },
        members: std::iter::once(card.id).chain(added.ties.iter().map(|c| c.id)).collect(),
        channel,
        parameters: parameters(fitted, card),
        stretches: replicated.count,
        explained,
        impact: impact(fitted, card, &x, &change),
        why,
        ..Finding::of(card)
    };
    let change = x.iter().zip(&point.x).map(|(without, with)| without - with).collect();
    let (material, bounded) = (is_material(card, &point.x), is_bounded(fitted.problem, card, &point.x));
    Judged { finding, material, bounded, change }
}

/// What goes with an effect.
struct Explained {
    /// Shares of the residual power of the channels that the effect itself changes.
    shares: BTreeMap<&'static str, f64>,
    /// Its channel of the largest.
    channel: &'static str,
    /// Whether other channels gain, by what the base does better beside it.
    elsewhere: bool,
}

/// What goes with an effect, which changes the prediction by `change`.
fn explained(fitted: &FittedSelection, card: &Card, change: &ChannelValues) -> Explained {
    let point = fitted.point();
    let residual = &point.residual;
    let power = |v: &[f64]| mean(&v.iter().map(|x| x * x).collect::<Vec<_>>());
    let own = fitted.places(card);
    let changes = |c: usize| own.is_empty() || own.iter().any(|&i| !point.white[i][c].is_empty());
    let mut out = Explained { shares: BTreeMap::new(), channel: "", elsewhere: false };
    let mut most = 0.0;
    // What channels of another kind gain is the base's, which is free to serve them.
    let known = |c: &usize| !residual[*c].is_empty() && !change[*c].is_empty() && card.channels.contains(&kind(*c));
    for c in (0..CHANNELS).filter(known) {
        let before: Vec<f64> = residual[c].iter().zip(&change[c]).map(|(r, d)| r + d).collect();
        let share = 1.0 - power(&residual[c]) / power(&before).max(1e-300);
        if !changes(c) {
            out.elsewhere |= share > EXPLAINS_ANYTHING.get();
            continue;
        }
        if share > EXPLAINS_ANYTHING.get() {
            out.shares.insert(NAMES[c].0, share);
        }
        if share > most || out.channel.is_empty() {
            (most, out.channel) = (share, NAMES[c].0);
        }
    }
    out
}

/// Change of the prediction that the effect makes, by channel, beside what the other numbers could take over, in
/// physical units; and the numbers without it.
fn without(fitted: &FittedSelection, card: &Card) -> (Vec<f64>, ChannelValues) {
    let own = fitted.places(card);
    let rest = fitted.rest(&own);
    let mut plain = fitted.point().x.clone();
    span(card).for_each(|k| plain[k] = fitted.problem.model.base[k]);
    let mut taken_over = plain.clone();
    let prior: Vec<f64> =
        rest.iter().map(|&i| fitted.problem.model.numbers[fitted.point().free[i]].trust.powi(-2)).collect();
    if let Some(inner) = inverse(&Grams::pick(&fitted.grams.sum, &rest, &rest), &prior).filter(|_| !own.is_empty()) {
        let absorbed = inner * Grams::pick(&fitted.grams.sum, &rest, &own);
        for (a, &i) in rest.iter().enumerate() {
            let k = fitted.point().free[i];
            let number = &fitted.problem.model.numbers[k];
            let size = |j: usize| fitted.point().x[fitted.point().free[j]] - plain[fitted.point().free[j]];
            let taken: f64 = own.iter().enumerate().map(|(b, &j)| absorbed[(a, b)] * size(j)).sum();
            taken_over[k] = (taken_over[k] + taken).clamp(number.low, number.high);
        }
    }
    // A large effect is not linear: where what the others take over by its slope makes it worse, they are left as they
    // are.
    let judged = |x: Vec<f64>| {
        let state = fitted.problem.predict(&x);
        let residual = fitted.problem.residuals(&state);
        let off = |c: usize| {
            let sd = fitted.selection.whitener.sd(c).max(1e-12);
            residual[c].iter().map(|r| (r / sd).powi(2)).sum::<f64>()
        };
        ((0..CHANNELS).map(off).sum::<f64>(), x, state)
    };
    let (_, x, state) = [plain, taken_over].map(judged).into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("two");
    let (with, without) = (fitted.problem.pick(&fitted.point().state), fitted.problem.pick(&state));
    let change = std::array::from_fn(|c| with[c].iter().zip(&without[c]).map(|(a, b)| a - b).collect());
    (x, change)
}
