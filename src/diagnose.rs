//! What the simulation gets wrong, and why: from the residuals of flights to the effects that explain them.
//!
//! Flights are predicted by the simulator's own equations ([`predict`]) and held against the measurement by channel ([`problem`]). Every effect of the
//! catalogue is a direction in which the prediction could change; a score test ranks them beside what the compact model's own numbers could take up
//! ([`gram`], [`select`]), the best are fitted ([`fit`]), and what is found has to be evident, replicated, of a size that matters ([`judge`]) and
//! complete: nothing structured may be left ([`structure`]).

// Samples, axes and channels index several arrays at once here.
#![allow(clippy::needless_range_loop)]

pub mod drift;
pub mod extend;
pub mod figures;
pub mod finding;
pub mod fit;
pub mod gain;
pub mod gram;
pub mod horizon;
pub mod judge;
pub mod model;
pub mod place;
pub mod plan;
pub mod predict;
pub mod problem;
pub mod random;
pub mod record;
pub mod ringing;
pub mod select;
pub mod skew;
pub mod structure;
pub mod whiten;

use crate::effects::{self, Kind};
use crate::flight::quality::Quality;
use crate::identify::data::Data;
use crate::stats::mean;
use crate::vehicle::Vehicle;
use finding::{Diagnosis, Finding, Residual, Status, Verdict};
use judge::{Judge, Judged};
use model::Model;
use problem::Problem;
use record::Record;
use select::{Added, Selection};
use std::collections::BTreeMap;
use structure::{NAMES, Structure};

/// What the diagnosis is busy with: called before each step with its name and the share done so far.
pub type Watch<'a> = &'a mut dyn FnMut(&str, f64);

/// Period of the commands, s.
const CONTROL_S: f64 = 0.01;
/// Structure that nobody needs to care about, as a root mean square: rad/s, m/s2, V.
const IDLE: [f64; 3] = [0.025, 0.08, 0.02];
/// Structure beside the noise, and beside what the findings explain of the same channel, that is called unexplained.
const LEFT_OF_NOISE: f64 = 0.15;
const LEFT_OF_EXPLAINED: f64 = 0.2;
/// Structure that lines up with a signal counts from this share of those sizes on.
const SURER: f64 = 0.37;
/// What a finding explains has to be so many times the structure that is left.
const ADEQUATE: f64 = 1.5;
/// What has a memory, where it is unexplained, may be so many times what a finding explains; measured flights are never white.
const MEMORY: f64 = 3.0;
/// Share of what is unexplained that goes with time from which on a finding is not the same early and late.
const CHANGES: f64 = 0.2;
/// Share of a channel besides its own from which on a finding is about it.
const ABOUT: f64 = 0.05;

/// Flights and their diagnosis, with all that a report needs.
pub struct Diagnosed {
    pub diagnosis: Diagnosis,
    /// The base vehicle with what was found.
    pub vehicle: Vehicle,
    pub problem: Problem,
    pub selection: Selection,
}

/// Flights, ready to be held against `vehicle`.
pub fn problem(logs: Vec<Quality>, vehicle: &Vehicle) -> Problem {
    let data = Data::new(logs);
    let one = |f| Record::new(f, record::full_rate(vehicle, &f.quality));
    let records: Vec<Record> = data.flights.iter().map(one).collect();
    let begin: Vec<f64> =
        records.iter().map(|r| r.volts.first().map_or(vehicle.battery.full_v, |first| first.1)).collect();
    let mut model = Model::new(vehicle, &begin);
    if records.iter().all(|r| r.from_rotors) {
        model.forget_voltage();
    }
    Problem::new(model, records)
}

/// Diagnoses flights of a vehicle that is thought to be `vehicle`.
pub fn diagnose(logs: Vec<Quality>, vehicle: &Vehicle, watch: Watch) -> Diagnosed {
    watch("predicting", 0.02);
    let usable_s = logs.iter().map(|q| crate::flight::spans::length(&q.usable)).sum();
    let problem = problem(logs, vehicle);
    let mut selection = select::select(&problem, watch);
    settle_clocks(&problem, &mut selection);
    let lost = settle_chance(&problem, &mut selection);
    watch("judging", 0.85);
    let structure = structure::search(&problem, &selection.point.state, &selection.point.residual);
    let before = structure::search(&problem, &selection.base.state, &selection.base.residual);
    let judge = Judge::new(&problem, &selection);
    let mut judged: Vec<Judged> = selection.added.iter().map(|a| judge.judge(a)).filter(|j| j.material).collect();
    judged.extend(biases(&judge));
    let mut findings: Vec<Finding> = judged.iter().map(|j| j.finding.clone()).collect();
    if let (Some(lost), Some(finding)) = (lost, findings.iter_mut().find(|f| f.effect == "command_dropout")) {
        finding.counted(&lost);
    }
    let placed = structure.iter().any(|s| s.along == Some(structure::PLACE));
    let force_structure = structure.iter().filter(|s| s.channel.starts_with("specific force")).map(|s| s.structure_rms);
    if !placed {
        findings.extend(random::gusts(&problem, &selection, force_structure.fold(0.0, f64::max)));
    }
    let (drift, cause) = drift::find(&judge);
    findings.extend(cause);
    let unexplained = unexplained(&structure, &findings, &selection);
    for finding in findings.iter_mut().filter(|f| f.status != Status::Suspected) {
        if let Some(why) = doubt(finding, &structure, &unexplained) {
            (finding.status, finding.why) = (Status::Suspected, Some(why));
        }
    }
    for finding in findings.iter_mut().filter(|f| placed && f.effect == "steady_wind") {
        finding.status = Status::Suspected;
        finding.why = Some("the wind is not the same everywhere".into());
    }
    // A move of the base explains nothing where its channel still has structure.
    let open = unexplained.iter().any(|s| s.channel == "specific force z");
    for finding in findings.iter_mut().filter(|f| open && f.explained.contains_key(drift::MOVES)) {
        finding.status = Status::Suspected;
        finding.why = Some("structure remains in specific force z".into());
    }
    watch("measuring the gain", 0.9);
    // What is only suspected is no part of the extended vehicle.
    let suspected: Vec<&str> = findings.iter().filter(|f| f.status == Status::Suspected).map(|f| f.effect).collect();
    let doubted = selection.added.iter().any(|a| suspected.contains(&a.card.id));
    let kept = doubted.then(|| selection.without(&problem, &suspected));
    let kept = kept.as_ref().unwrap_or(&selection);
    let held = gain::measure(&problem, &selection, kept);
    for finding in &mut findings {
        let one = judged.iter().find(|j| j.finding.effect == finding.effect);
        let is_held = finding.status != Status::Suspected;
        let all = one.map_or(held.channels.clone(), |j| held.of_one(&problem, &j.change, is_held));
        finding.gain = all.into_iter().filter(|(c, _)| finding.explained.contains_key(c)).collect();
    }
    findings.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    let verdict = match (unexplained.is_empty(), findings.is_empty()) {
        (false, _) => Verdict::Unexplained,
        (true, true) => Verdict::Clean,
        (true, false) => Verdict::Effects,
    };
    let (detectable, not_detectable) = plan::judge(&problem, &selection.reach);
    let extended = extend::vehicle(&Judge::new(&problem, kept), &findings);
    let diagnosis = Diagnosis {
        verdict,
        logs: problem.records.iter().map(|r| r.name.clone()).collect(),
        base: vehicle.name.clone(),
        usable_s,
        findings,
        unexplained,
        not_detectable,
        detectable,
        drift,
        residuals: residuals(&problem, &selection),
        held_out: held.channels,
        horizons: held.horizons,
        captured: held.captured,
        structure_before: before,
        structure,
    };
    Diagnosed { diagnosis, vehicle: extended, problem, selection }
}

/// Why a finding is no more than suspected beside what is left, if so.
fn doubt(finding: &Finding, structure: &[Structure], unexplained: &[Structure]) -> Option<String> {
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
    // What swings pulls like a drag that comes late.
    let drag = effects::card(finding.effect).is_some_and(|card| card.kind == Kind::Drag);
    let most = structure.iter().filter_map(explained).fold(0.0, f64::max);
    let swing = |s: &&Structure| s.along.is_some_and(ringing::is_swing) && s.structure_rms > most / MEMORY;
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

/// By impact; what is only suspected comes last.
fn rank(finding: &Finding) -> f64 {
    finding.impact + if finding.status == Status::Suspected { 0.0 } else { 1e6 }
}

/// A gyro that comes late, after commands and after the odometry by the same time, is stamped late: one cause, not two of the same size.
fn settle_clocks(problem: &Problem, selection: &mut Selection) {
    /// Agreement of the two times, s, and as a share.
    const SAME: [f64; 2] = [6e-4, 0.05];
    let [Some(delay), Some(offset)] = ["rate_delay", "stream_offset"].map(effects::card) else { return };
    let moved = mean(&problem.records.iter().map(|r| r.moved).collect::<Vec<_>>());
    let [asked, stamped] = [delay, offset].map(|card| model::span(card).start);
    let Some(i) = selection.added.iter().position(|a| a.card.id == delay.id || a.card.id == offset.id) else { return };
    let mut x = selection.point.x.clone();
    let late = x[asked] + x[stamped];
    let both = selection.added.iter().filter(|a| a.card.id == delay.id || a.card.id == offset.id).count() > 1;
    if moved == 0.0 || both || (late - moved).abs() > SAME[0] + SAME[1] * moved.abs() {
        return;
    }
    (x[asked], x[stamped]) = (0.0, late);
    let mut free = selection.point.free.clone();
    free.retain(|k| *k != asked && *k != stamped);
    free.push(stamped);
    selection.added[i] = Added { card: offset, ties: Vec::new() };
    selection.point = fit::fit(problem, &selection.whitener, &x, &free);
}

/// Lost commands and a short delay have the same mean: what single stick movements leave decides.
fn settle_chance(problem: &Problem, selection: &mut Selection) -> Option<random::Lost> {
    let dropout = effects::card("command_dropout")?;
    let lost = random::lost_commands(problem, selection);
    let are_lost = random::are_lost(&lost, dropout);
    let at = |card: &effects::Card| model::span(card).start;
    let mut x = selection.point.x.clone();
    let mut free = selection.point.free.clone();
    // A delay that lost commands account for is none.
    let explained = |a: &Added, x: &[f64]| a.card.id == "rate_delay" && x[at(a.card)] < 3.0 * lost.share * CONTROL_S;
    if are_lost {
        let gone: Vec<Added> =
            selection.added.iter().filter(|a| explained(a, &x) || a.card.id == dropout.id).cloned().collect();
        for a in &gone {
            model::span(a.card).for_each(|k| x[k] = 0.0);
            free.retain(|k| !model::span(a.card).contains(k));
            selection.added.retain(|other| other.card.id != a.card.id);
        }
        selection.added.push(Added { card: dropout, ties: Vec::new() });
        // Counted, not fitted: its mean is a delay that the time constants take up.
        x[at(dropout)] = lost.share;
    } else if let Some(i) = selection.added.iter().position(|a| a.card.id == dropout.id) {
        // Its mean is there, its variance is not: the rival that has the same mean.
        let other = selection.added[i].ties.first().copied().or(effects::card("rate_delay"));
        let other = other.filter(|o| selection.added.iter().all(|a| a.card.id != o.id));
        let mean = std::mem::take(&mut x[at(dropout)]) * CONTROL_S;
        free.retain(|k| *k != at(dropout));
        selection.added.remove(i);
        if let Some(other) = other {
            x[at(other)] = mean;
            free.extend(model::span(other));
            selection.added.insert(i, Added { card: other, ties: Vec::new() });
        }
    } else {
        selection.added.iter_mut().for_each(|a| a.ties.retain(|c| c.id != dropout.id));
        return None;
    }
    selection.point = fit::fit(problem, &selection.whitener, &x, &free);
    are_lost.then_some(lost)
}

/// Constant errors of the IMU, which every fit allows for.
fn biases(judge: &Judge) -> Vec<Judged> {
    // Larger than what any such sensor has, by a share of the smallest size that is one.
    const SHARE: f64 = 0.8;
    let point = &judge.selection.point;
    let seen = |first: usize| !judge.problem.rows[first].is_empty();
    let mut out = Vec::new();
    for (id, channel) in [("gyro_bias", 6), ("accel_bias", 9)] {
        let Some(card) = effects::card(id) else { continue };
        let size = model::span(card).map(|k| point.x[k].powi(2)).sum::<f64>().sqrt();
        if seen(channel) && size > SHARE * card.parameters[0].typical[0] {
            out.push(judge.judge(&Added { card, ties: Vec::new() }));
        }
    }
    out
}

/// Channels in which structure is left that matters, beside the noise and beside what the findings explain.
fn unexplained(structure: &[Structure], findings: &[Finding], selection: &Selection) -> Vec<Structure> {
    let gusts = findings.iter().any(|f| f.effect == "gusts");
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

fn residuals(problem: &Problem, selection: &Selection) -> BTreeMap<&'static str, Residual> {
    let mut out = BTreeMap::new();
    for (c, (name, unit)) in NAMES.into_iter().enumerate() {
        let (base, now) = (&selection.base.residual[c], &selection.point.residual[c]);
        if base.is_empty() {
            continue;
        }
        let rms = |r: &[f64]| mean(&r.iter().map(|x| x * x).collect::<Vec<_>>()).sqrt();
        let middle = mean(&problem.measured[c]);
        let variance = mean(&problem.measured[c].iter().map(|m| (m - middle).powi(2)).collect::<Vec<_>>()).max(1e-300);
        let (before, after) = (rms(base), rms(now));
        let noise = selection.whitener.sd(c);
        let (r2_before, r2_after) = (1.0 - before * before / variance, 1.0 - after * after / variance);
        out.insert(name, Residual { before, after, noise, unit, r2_before, r2_after });
    }
    out
}
