//! Whether what was found is enough: what structure is left, and which findings are in doubt beside it.

use super::finding::Finding;
use super::oscillation;
use super::select::Selection;
use super::structure::{NAMES, Structure};
use crate::base::stats::mean;
use crate::model::effects::{self, EffectKind, Role};

/// Structure that nobody needs to care about, as a root mean square: rad/s, m/s2, V.
const IDLE: [f64; 3] = [0.025, 0.08, 0.02];
/// Structure beside the noise, and beside what the findings explain of the same channel, that is called unexplained.
const LEFT_OF_NOISE: f64 = 0.15;
const LEFT_OF_EXPLAINED: f64 = 0.2;
/// Structure that lines up with a signal counts from this share of those sizes on.
const SURER: f64 = 0.37;
/// What a finding explains has to be so many times the structure that is left.
const ADEQUATE: f64 = 1.5;
/// What has a memory, where it is unexplained, may be so many times what a finding explains; measured flights are never
/// white.
const MEMORY: f64 = 3.0;
/// Share of what is unexplained that goes with time from which on a finding is not the same early and late.
const CHANGES: f64 = 0.2;
/// What explains less than this share of what the largest finding of its channel does is small beside it.
const BESIDE: f64 = 0.05;
/// Share of a channel besides its own from which on a finding is about it.
const ABOUT: f64 = 0.05;

/// Channels in which structure is left that matters, beside the noise and beside what the findings explain.
pub fn unexplained(structure: &[Structure], findings: &[Finding], selection: &Selection) -> Vec<Structure> {
    let gusts = findings.iter().any(|f| f.has(Role::RandomForce));
    let one = |s: &&Structure| {
        let Some(c) = NAMES.iter().position(|(name, _)| *name == s.channel) else { return false };
        let idle = IDLE[if c < 3 {
            0
        } else if c < 6 {
            1
        } else {
            2
        }];
        let before = mean(&selection.base.residual[c].iter().map(|r| r * r).collect::<Vec<_>>());
        let explained = (before - s.rms * s.rms).max(0.0).sqrt();
        let gusty = gusts && (3..6).contains(&c);
        // What lines up with a signal is surer than what only has a memory.
        let surer = if gusty { 1.0 } else { SURER };
        let left = (s.structure_rms / surer).max(if gusty { 0.0 } else { s.coloured_rms });
        left > idle && left > LEFT_OF_NOISE * s.rms && left > LEFT_OF_EXPLAINED * explained
    };
    structure.iter().filter(one).cloned().collect()
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
        (share > if s.channel == finding.channel { 1e-3 } else { ABOUT })
            .then(|| s.rms * (share / (1.0 - share)).sqrt())
    };
    let more = |s: &Structure| format!("more structure remains in {} than it explains", s.channel);
    if let Some(left) = structure.iter().find(|s| s.channel == finding.channel)
        && explained(left).is_some_and(|explained| left.structure_rms > explained / ADEQUATE)
    {
        return Some(more(left));
    }
    if bounded && unexplained.iter().any(|s| s.channel == finding.channel) {
        return Some("its size ends at the bound of what it can be, and structure remains".into());
    }
    // Where the largest cause has not quite the right form, small ones make up for it.
    let odds = |f: &Finding| f.explained.get(finding.channel).map_or(0.0, |s| s / (1.0 - s.min(0.999_999)));
    let largest = findings.iter().max_by(|a, b| odds(a).total_cmp(&odds(b)));
    if let Some(largest) = largest.filter(|l| odds(finding) < BESIDE * odds(l))
        && unexplained.iter().any(|s| s.channel == finding.channel)
    {
        return Some(format!("small beside {}, where structure remains: it may make up for its form", largest.name));
    }
    // What swings pulls like a drag that comes late.
    let drag = effects::card(finding.effect).is_some_and(|card| card.kind == EffectKind::Drag);
    let most = structure.iter().filter_map(explained).fold(0.0, f64::max);
    let swing = |s: &&Structure| s.along.is_some_and(oscillation::is_swing) && s.structure_rms > most / MEMORY;
    if let Some(left) = unexplained.iter().find(swing).filter(|_| drag) {
        return Some(format!("something swings in {}, which looks like drag too", left.channel));
    }
    unexplained.iter().filter_map(|s| Some((s, explained(s)?))).find_map(|(left, explained)| {
        if left.channel == finding.channel && left.coloured_rms > MEMORY * explained {
            return Some(more(left));
        }
        let with_time = left.along.is_some_and(|along| along.ends_with("time") && left.along_share > CHANGES);
        with_time.then(|| format!("what it explains in {} changes during the flight", left.channel))
    })
}
