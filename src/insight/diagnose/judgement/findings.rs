//! Everything that was found: the judged effects, gusts, and what moved against the base vehicle; and which of them
//! what is left puts in doubt.

use super::adequacy;
use super::cause::MOVES;
use super::constant::constant_errors;
use super::diagnosis::Drift;
use super::drift;
use super::finding::{Finding, Status, Value};
use super::gusts;
use super::judge::{Judged, judge};
use super::parts::or_parts;
use crate::insight::criteria::material::{LEAST_IMPACT, LEAST_SENSOR_IMPACT};
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::diagnose::selection::lost::Lost;
use crate::insight::diagnose::structure::{PLACE, Structure};
use crate::model::effects::{self, EffectKind, Role, are_rivals};

/// What was found.
pub struct Judgement {
    pub findings: Vec<Finding>,
    pub judged: Vec<Judged>,
    pub drift: Vec<Drift>,
    pub unexplained: Vec<Structure>,
    /// Evident, and too small to matter.
    pub small: Vec<Finding>,
}

/// Judges a selection that leaves `structure`, of flights that lose so many commands.
pub fn find(fitted: &FittedSelection, lost: Option<Lost>, structure: &[Structure]) -> Judgement {
    let added = fitted.selection.added.iter().map(|a| judge(fitted, a)).chain(constant_errors(fitted));
    let (judged, small): (Vec<Judged>, Vec<Judged>) = added.partition(matters);
    let small = small.into_iter().map(|j| j.finding).filter(|f| f.status != Status::Suspected).collect();
    let mut findings: Vec<Finding> = judged.iter().map(|j| j.finding.clone()).collect();
    if let Some(lost) = lost {
        findings.iter_mut().filter(|f| f.has(Role::CommandsLost)).for_each(|f| count(f, &lost));
    }
    let placed = structure.iter().any(|s| s.along == Some(PLACE));
    if !placed {
        let forces = structure.iter().filter(|s| s.channel.starts_with("specific force")).map(|s| s.structure_rms);
        findings.extend(gusts::find(fitted.problem, fitted.selection, forces.fold(0.0, f64::max)));
    }
    // Commands that get lost are outliers, and the fit hears those that arrive: their mean delay would be taken twice.
    let heard = lost.map(|_| fitted.selection.but(fitted.problem, &ids(Role::CommandsLost)));
    let (drift, cause) = match &heard {
        Some(heard) => drift::find(&FittedSelection::new(fitted.problem, heard)),
        None => drift::find(fitted),
    };
    findings.extend(cause);
    let unexplained = adequacy::unexplained(structure, &findings, fitted.selection);
    let mut found = Judgement { findings, judged, drift, unexplained, small };
    found.doubt(structure, placed);
    found
}

impl Judgement {
    /// What is left makes findings no more than suspected.
    fn doubt(&mut self, structure: &[Structure], placed: bool) {
        let all = self.findings.clone();
        for finding in self.findings.iter_mut().filter(|f| f.status != Status::Suspected) {
            let bounded = self.judged.iter().any(|j| j.bounded && j.finding.effect == finding.effect);
            if let Some(why) = adequacy::doubt(finding, bounded, &all, structure, &self.unexplained) {
                finding.suspect(why);
            } else if bounded {
                // What ends at the bound of its range stands in for something else.
                or_rivals(finding, &all);
            }
        }
        for finding in self.findings.iter_mut().filter(|f| placed && f.has(Role::UniformWind)) {
            finding.suspect("the wind is not the same everywhere".into());
        }
        let windy = self.findings.iter().any(|f| f.has(Role::UniformWind) && f.status != Status::Suspected);
        for finding in self.findings.iter_mut().filter(|f| windy && gusts::rivals::last_like_wind(f)) {
            finding.suspect("beside a wind it lasts for seconds: the wind may turn, or grow with height".into());
        }
        let sure_gusts = |f: &&Finding| f.has(Role::RandomForce) && f.status != Status::Suspected;
        let pushes = self.findings.iter().find(sure_gusts).map_or(0.0, |gusts| gusts.impact);
        for finding in self.findings.iter_mut().filter(|f| gusts::rivals::may_be(pushes, f)) {
            finding.suspect("moving air makes as much of a drag by the square of the speed".into());
        }
        for finding in self.findings.iter_mut().filter(|f| f.status == Status::Named) {
            open(finding, &all, &self.unexplained);
        }
        self.findings.iter_mut().for_each(or_parts);
        for left in structure.iter().filter(|s| adequacy::remembers(s)) {
            family(&mut self.findings, left.channel);
        }
        // A move of the base explains nothing where what is left of its channel is no noise.
        let open = structure.iter().any(|s| s.channel == "specific force z" && adequacy::remembers(s));
        for finding in self.findings.iter_mut().filter(|f| open && f.explained.contains_key(MOVES)) {
            finding.suspect("structure remains in specific force z".into());
        }
    }
}

/// Where structure is left in what a finding explains most of, its form is not quite right, and it may be a rival, of
/// which the form is not either.
fn open(finding: &mut Finding, all: &[Finding], unexplained: &[Structure]) {
    if unexplained.iter().any(|s| s.channel == finding.channel) {
        or_rivals(finding, all);
    }
}

/// It may be any of its rivals that write the same and were not found.
fn or_rivals(finding: &mut Finding, all: &[Finding]) {
    let Some(card) = effects::card(finding.effect) else { return };
    let found = |id: &str| all.iter().any(|f| f.effect == id);
    let same = |id: &&str| effects::card(id).is_some_and(|rival| rival.writes == card.writes);
    card.rivals.iter().copied().filter(same).filter(|id| !found(id)).for_each(|id| finding.or(id));
}

/// Where `channel` still has a memory, of rivals that both explain some of it one has the name: its form is not right,
/// and with the others it comes nearer.
fn family(findings: &mut Vec<Finding>, channel: &str) {
    let share = |f: &Finding| f.explained.get(channel).copied().filter(|_| f.status != Status::Suspected);
    let mut order: Vec<(&'static str, f64)> = findings.iter().filter_map(|f| Some((f.effect, share(f)?))).collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    for (at, &(larger, _)) in order.iter().enumerate() {
        for &(smaller, _) in &order[at + 1..] {
            let place = |id: &str| findings.iter().position(|f| f.effect == id);
            let [Some(a), Some(b)] = [larger, smaller].map(effects::card) else { continue };
            let (Some(_), Some(i)) = (place(larger), place(smaller)) else { continue };
            if are_rivals(a, b) && a.writes == b.writes {
                let other = findings.remove(i);
                findings.iter_mut().filter(|f| f.effect == larger).for_each(|f| f.with(other.clone()));
            }
        }
    }
}

/// Whether anybody would notice.
fn matters(judged: &Judged) -> bool {
    let finding = &judged.finding;
    let least = match effects::card(finding.effect).map(|card| card.kind) {
        // What the voltage does is felt in the thrust long after.
        Some(EffectKind::Battery) | None => 0.0,
        Some(EffectKind::Sensor) => LEAST_SENSOR_IMPACT.get(),
        Some(_) => LEAST_IMPACT.get(),
    };
    let constant = finding.has(Role::ConstantError);
    (judged.material || constant) && (finding.impact >= least || finding.has(Role::CommandsLost))
}

fn ids(role: Role) -> Vec<&'static str> {
    effects::acting(role).map(|card| card.id).collect()
}

/// Lost commands, as counted.
fn count(finding: &mut Finding, lost: &Lost) {
    let [low, high] = lost.interval;
    let counted = effects::card(finding.effect).into_iter().flat_map(|card| card.parameters.first());
    for p in counted {
        finding.parameters.insert(p.name.into(), Value { value: lost.share, low, high, unit: p.unit.into() });
    }
    finding.stretches = lost.whole as f64;
    (finding.status, finding.why, finding.members) = (Status::Named, None, vec![finding.effect]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::effects::{Card, ResidualChannel};

    #[test]
    fn of_rivals_beside_structure_one_has_the_name() {
        let pushes = || effects::MODEL.into_iter().filter(|card| card.channels == [ResidualChannel::Force]);
        let rivals = |a: &Card, b: &Card| are_rivals(a, b) && a.writes == b.writes;
        let (a, b) = pushes().flat_map(|a| pushes().map(move |b| (a, b))).find(|(a, b)| rivals(a, b)).expect("rivals");
        let other = pushes().find(|c| c.id != a.id && c.id != b.id && !rivals(a, c) && !rivals(b, c)).expect("another");
        let said = |card: &'static Card, share: f64| {
            let explained = [("specific force z", share)].into();
            Finding { status: Status::Named, members: vec![card.id], explained, ..Finding::of(card) }
        };
        let mut findings = vec![said(a, 0.34), said(other, 0.3), said(b, 0.41)];
        family(&mut findings, "specific force x");
        assert!(findings.iter().all(|f| f.status == Status::Named), "nothing of theirs is there");
        family(&mut findings, "specific force z");
        assert_eq!(findings.iter().map(|f| f.effect).collect::<Vec<_>>(), [other.id, b.id]);
        assert_eq!((findings[1].status, &findings[1].members[..]), (Status::NamedSet, &[b.id, a.id][..]));
        assert_eq!(findings[1].cards().map(|(card, _)| card.id).collect::<Vec<_>>(), [b.id, a.id]);
    }

    #[test]
    fn what_may_be_a_rival_is_one_of_several() {
        let same = |a: &Card, b: &Card| a.rivals.contains(&b.id) && a.writes == b.writes;
        let card = effects::cards().find(|a| effects::cards().any(|b| same(a, b))).expect("one with such a rival");
        let rivals: Vec<&str> = effects::cards().filter(|b| same(card, b)).map(|b| b.id).collect();
        let named = || Finding { status: Status::Named, members: vec![card.id], ..Finding::of(card) };
        let mut alone = named();
        or_rivals(&mut alone, &[]);
        assert!(alone.status == Status::NamedSet && rivals.iter().all(|id| alone.members.contains(id)));
        let mut beside = named();
        let found: Vec<Finding> = rivals.iter().filter_map(|id| effects::card(id)).map(Finding::of).collect();
        or_rivals(&mut beside, &found);
        assert!(beside.status == Status::Named, "those that were found have names of their own");
    }
}
