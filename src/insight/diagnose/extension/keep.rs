//! What of a selection is kept: the extended vehicle's part, in which every name has to hold by itself.

use super::extend;
use super::names::{blame, named, suspect_unsure};
use super::own_numbers::{like, own, unpaid};
use super::worse::{self, Than, Unextended, Worse};
use crate::base::check::Check;
use crate::insight::diagnose::judgement::finding::Finding;
use crate::insight::diagnose::prediction::channels::LIFT;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{self, Card, EffectKind, MODEL, Role};

/// More than any share by which a part is worse.
const OVER_ALL: f64 = 1e6;
const UNSEEN: &str = "on flight that was not used for fitting it";

/// What of the selection is kept: what is only suspected is no part of the extended vehicle, nor what is not sure
/// without that, nor what makes unseen flight worse where what is left does not. With the reason why it is worse, even
/// than the vehicle that was given, where nothing helps: then every name stands as it did.
pub fn keep(problem: &Problem, selection: &Selection, findings: &mut [Finding]) -> (Selection, Option<String>) {
    let reference = Unextended::new(problem, selection);
    let caused = with_cause(&reference, selection, findings);
    let selection = caused.as_ref().unwrap_or(selection);
    let mut given: Vec<usize> = Vec::new();
    let mut before_blame: Option<(Selection, Option<String>, Vec<Finding>)> = None;
    loop {
        let kept = Remaining::of(&reference, selection, findings, &given);
        if suspect_unsure(&FittedSelection::new(problem, &kept.selection), findings) {
            continue;
        }
        if kept.wrong() == 0.0 {
            let unpaid = unpaid(problem, &kept.selection);
            let together = (unpaid.len() > 1).then(|| unpaid.concat());
            let mut more = together.into_iter().chain(unpaid).map(|group| [&given[..], &group].concat());
            let no_worse = |group: &Vec<usize>| Remaining::of(&reference, selection, findings, group).wrong() == 0.0;
            let Some(group) = more.find(no_worse) else { return (kept.selection, None) };
            given = group;
            continue;
        }
        // Before an effect is to blame, the vehicle's own numbers: flights need not tell them as well as the base does.
        let channel = kept.worse.as_ref().map_or(LIFT, |worse| worse.number);
        let groups = [own(channel), like(problem, channel)].map(|group| [&given[..], &group].concat());
        let free = |group: &[usize]| group.iter().any(|k| kept.selection.point.free.contains(k));
        let mut tried = groups.into_iter().filter(|group| free(group));
        let better = |group: &Vec<usize>| Remaining::of(&reference, selection, findings, group).wrong() < kept.wrong();
        if let Some(group) = tried.find(better) {
            given = group;
            continue;
        }
        let rise = kept.worse.as_ref().map(|worse| format!("{} {:.0} % worse", worse.channel, 100.0 * worse.by));
        let blamed = |f: &&mut Finding| match &kept.worse {
            Some(worse) => worse.blamed.is_some_and(|card| card.id == f.effect),
            None => effects::card(f.effect).is_some_and(|card| card.kind == EffectKind::Battery),
        };
        let why = rise.as_ref().map(|rise| format!("{UNSEEN} predicts {rise}"));
        let as_they_were = findings.to_vec();
        // What only comes nearer to a form goes before the name does.
        let whose =
            |f: &&mut Finding| kept.worse.as_ref().and_then(|w| w.blamed).is_some_and(|card| f.with.contains(&card.id));
        if let Some(finding) = named(findings).find(whose) {
            finding.with.clear();
            continue;
        }
        let Some(finding) = named(findings).filter(|f| f.cause.is_none() && f.in_vehicle()).find(blamed) else {
            let (kept, why, as_they_were) = before_blame.unwrap_or((kept.selection, why, as_they_were));
            findings.clone_from_slice(&as_they_were);
            let all = [like(problem, 0), like(problem, LIFT)].concat();
            let groups = [own(channel), like(problem, channel), all];
            let no_worse = |group| Remaining::than(Than::Given, &reference, selection, findings, group).done();
            return groups.iter().find_map(|group| no_worse(group)).map_or((kept, why), |kept| (kept, None));
        };
        before_blame.get_or_insert((kept.selection, why, as_they_were));
        let why = match rise {
            Some(rise) => format!("{UNSEEN} makes {rise}"),
            None => "at rest the pack would be above the voltages that the thrust is told at".into(),
        };
        blame(finding, why, kept.worse.as_ref().map(|worse| worse.channel));
    }
}

/// The selection with the named cause of all moves of thrust and drag in their place, where that is no worse.
fn with_cause(reference: &Unextended, selection: &Selection, findings: &mut [Finding]) -> Option<Selection> {
    let (cause, way) = named(findings).find_map(|f| Some((&*f, f.cause?)))?;
    let size = cause.parameters.get(way.card.parameters[0].name)?.value;
    let caused = selection.with_cause(reference.problem, way, size);
    let wrong = |selection| Remaining::of(reference, selection, findings, &[]).wrong();
    (wrong(&caused) <= wrong(selection)).then_some(caused)
}

/// A selection without what is not named, and what is wrong with that.
struct Remaining {
    selection: Selection,
    worse: Option<Worse>,
    flies: bool,
}

impl Remaining {
    /// With the numbers `given` as the base vehicle has them.
    fn of(reference: &Unextended, selection: &Selection, findings: &[Finding], given: &[usize]) -> Self {
        Self::than(Than::Either, reference, selection, findings, given)
    }

    /// The same held against `than`.
    fn than(than: Than, reference: &Unextended, selection: &Selection, findings: &[Finding], given: &[usize]) -> Self {
        let problem = reference.problem;
        let kept = selection.without(problem, &left_out(selection, findings)).with_given(problem, given);
        let worse = worse::find(&FittedSelection::new(problem, &kept), reference, than);
        let flies = extend::at_rest(problem, &kept).check().is_ok();
        Self { selection: kept, worse, flies }
    }

    /// The selection, if nothing is wrong with it.
    fn done(self) -> Option<Selection> {
        (self.wrong() == 0.0).then_some(self.selection)
    }

    /// The share by which a channel is worse; over all unseen flight more than in any part, and no vehicle more than
    /// that.
    fn wrong(&self) -> f64 {
        let by = |worse: &Worse| worse.by + if worse.whole { OVER_ALL } else { 0.0 };
        if self.flies { self.worse.as_ref().map_or(0.0, by) } else { f64::MAX }
    }
}

/// Effects of the selection that are no part of the extended vehicle's fit: what is suspected or makes unseen flight
/// worse, and of the simulator's whatever is not named, such as what is too small to matter. What the sensors are off
/// by stays with the flights. Lost commands are outliers: the fit hears those that arrive, and no mean delay of the
/// others.
fn left_out(selection: &Selection, findings: &[Finding]) -> Vec<&'static str> {
    let of = |f: &&Finding, card: &Card| f.cards().any(|(own, _)| own.id == card.id);
    let finding = |card: &Card| findings.iter().find(|f| of(f, card));
    let out = |card: &&'static Card| match finding(card) {
        Some(finding) => !finding.in_vehicle(),
        None => MODEL.iter().any(|of_vehicle| of_vehicle.id == card.id),
    };
    let unheard = |card: &&'static Card| card.role == Role::CommandsLost || out(card);
    selection.added.iter().map(|a| a.card).filter(unheard).map(|card| card.id).collect()
}
