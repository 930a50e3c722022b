//! Whether what was found is enough: what structure is left, and which findings are in doubt beside it.

use super::cause::MOVES;
use super::finding::{Finding, Status};
use crate::base::stats::mean;
use crate::insight::criteria::complete::{
    ABOUT_SHARE, ADEQUATE_RATIO, CHANGING_SHARE, LEFT_OF_EXPLAINED, LEFT_OF_NOISE, LINED_UP_SHARE, MEMORY_RATIO,
    REMEMBERED, SMALL_BESIDE,
};
use crate::insight::criteria::evident::EXPLAINS_ANYTHING;
use crate::insight::criteria::material::{IDLE_FORCE, IDLE_RATE, IDLE_VOLTAGE};
use crate::insight::diagnose::prediction::channels::NAMES;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::structure::Structure;
use crate::insight::diagnose::structure::oscillation;
use crate::model::effects::{self, EffectKind, Role};

/// Channels in which structure is left that matters, beside the noise and beside what the findings explain.
pub fn unexplained(structure: &[Structure], findings: &[Finding], selection: &Selection) -> Vec<Structure> {
    let gusts = findings.iter().any(|f| f.has(Role::RandomForce));
    let one = |s: &&Structure| {
        let Some(c) = NAMES.iter().position(|(name, _)| *name == s.channel) else { return false };
        let idle = if c < 3 {
            IDLE_RATE.get()
        } else if c < 6 {
            IDLE_FORCE.get()
        } else {
            IDLE_VOLTAGE.get()
        };
        let before = mean(&selection.base.residual[c].iter().map(|r| r * r).collect::<Vec<_>>());
        let explained = (before - s.rms * s.rms).max(0.0).sqrt();
        let gusty = gusts && (3..6).contains(&c);
        // What lines up with a signal is surer than what only has a memory.
        let surer = if gusty { 1.0 } else { LINED_UP_SHARE.get() };
        let left = (s.structure_rms / surer).max(if gusty { 0.0 } else { s.coloured_rms });
        left > idle && left > LEFT_OF_NOISE.get() * s.rms && left > LEFT_OF_EXPLAINED.get() * explained
    };
    structure.iter().filter(one).cloned().collect()
}

/// Whether the forms of what was found are not the vehicle's: most of what they leave of a force is known before.
pub fn remembers(left: &Structure) -> bool {
    let known = left.coloured_rms.max(left.structure_rms);
    left.channel.starts_with("specific force") && known > IDLE_FORCE.get() && known > REMEMBERED.get() * left.rms
}

/// Why a finding is no more than suspected beside what is left, if so.
pub fn doubt(
    finding: &Finding,
    bounded: bool,
    findings: &[Finding],
    structure: &[Structure],
    unexplained: &[Structure],
) -> Option<String> {
    let explained = |s: &Structure| {
        let share = finding.explained.get(s.channel)?.min(0.999_999);
        (share > if s.channel == finding.channel { EXPLAINS_ANYTHING.get() } else { ABOUT_SHARE.get() })
            .then(|| s.rms * (share / (1.0 - share)).sqrt())
    };
    let more = |s: &Structure| format!("more structure remains in {} than it explains", s.channel);
    if let Some(left) = structure.iter().find(|s| s.channel == finding.channel)
        && explained(left).is_some_and(|explained| left.structure_rms > explained / ADEQUATE_RATIO.get())
    {
        return Some(more(left));
    }
    if bounded && unexplained.iter().any(|s| s.channel == finding.channel) {
        return Some("its size ends at the bound of what it can be, and structure remains".into());
    }
    // Where the largest cause has not quite the right form, small ones make up for it.
    let odds = |f: &Finding| f.explained.get(finding.channel).map_or(0.0, |s| s / (1.0 - s.min(0.999_999)));
    let largest = findings.iter().max_by(|a, b| odds(a).total_cmp(&odds(b)));
    // What has no mean explains no share.
    let measured = !finding.has(Role::RandomForce) && !finding.explained.contains_key(MOVES);
    let small = |l: &&Finding| measured && odds(finding) < SMALL_BESIDE.get() * odds(l);
    // No estimator is late by one lag, or by one delay: what it leaves is small, and is its own.
    let estimated = |l: &Finding| l.has(Role::VelocityLag) && l.status != Status::Suspected;
    // What an axis has of its own is no form of what all have.
    let of_all = |l: &&Finding| !l.cards().any(|(card, _)| card.apart_from.contains(&finding.effect));
    if let Some(largest) = largest.filter(small).filter(of_all)
        && (estimated(largest) || unexplained.iter().any(|s| s.channel == finding.channel))
    {
        return Some(format!("small beside {}, whose form it may make up for", largest.name));
    }
    // What swings pulls like a drag that comes late.
    let drag = effects::card(finding.effect).is_some_and(|card| card.kind == EffectKind::Drag);
    let most = structure.iter().filter_map(explained).fold(0.0, f64::max);
    let swing =
        |s: &&Structure| s.along.is_some_and(oscillation::is_swing) && s.structure_rms > most / MEMORY_RATIO.get();
    if let Some(left) = unexplained.iter().find(swing).filter(|_| drag) {
        return Some(format!("something swings in {}, which looks like drag too", left.channel));
    }
    // What goes with the charge alone changes during a flight.
    let by_charge =
        effects::card(finding.effect).is_some_and(|card| card.kind == EffectKind::Battery && card.reads.is_empty());
    unexplained.iter().filter_map(|s| Some((s, explained(s)?))).find_map(|(left, explained)| {
        if left.channel == finding.channel && left.coloured_rms > MEMORY_RATIO.get() * explained {
            return Some(more(left));
        }
        let with_time = !by_charge
            && left.along.is_some_and(|along| along.ends_with("time") && left.along_share > CHANGING_SHARE.get());
        with_time.then(|| format!("what it explains in {} changes during the flight", left.channel))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Structure that matters, but is less than what either finding explains.
    const LEFT: Structure = Structure {
        channel: "yaw rate",
        unit: "rad/s",
        rms: 1.0,
        structure_rms: 0.02,
        coloured_rms: 0.0,
        along: None,
        along_share: 0.0,
        curve: Vec::new(),
        variance_along: None,
        variance_ratio: 1.0,
    };

    #[test]
    fn what_an_axis_has_of_its_own_makes_no_form_of_all_axes_small() {
        let own = effects::cards().find(|card| !card.apart_from.is_empty()).expect("one");
        let of_all = effects::card(own.apart_from[0]).expect("one");
        let other = effects::cards().find(|c| ![own.id, of_all.id].contains(&c.id) && c.apart_from.is_empty());
        let explains =
            |card, share| Finding { channel: "yaw rate", explained: [("yaw rate", share)].into(), ..Finding::of(card) };
        let why = |largest, small| {
            let findings = [explains(largest, 0.9), explains(small, 0.01)];
            doubt(&findings[1], false, &findings, &[LEFT], &[LEFT])
        };
        let other = other.expect("one");
        assert_eq!(why(other, of_all), Some(format!("small beside {}, whose form it may make up for", other.name)));
        assert_eq!(why(own, of_all), None);
    }
}
