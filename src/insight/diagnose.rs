//! What the simulation gets wrong, and why: from the residuals of flights to the effects that explain them.
//!
//! Flights are predicted by the simulator's own equations and held against the measurement by channel
//! ([`prediction`]). Every effect of the catalogue is a direction in which the prediction could change; a score test
//! ranks them beside what the compact model's own numbers could take up ([`selection`]), the best are fitted
//! ([`fitting`]), and what is found has to be evident, replicated, of a size that matters ([`judgement`]) and complete:
//! nothing structured may be left ([`structure`]). What holds makes the extended vehicle ([`extension`]), whose gain is
//! measured on flight that no fit has seen ([`gain`]).

// Samples, axes and channels index several arrays at once here.
#![allow(clippy::needless_range_loop)]

pub mod against;
pub mod extension;
pub mod figures;
pub mod fitting;
pub mod gain;
pub mod judgement;
pub mod motor_loop;
pub mod prediction;
pub mod selection;
pub mod structure;

use crate::base::stats::mean;
use crate::insight::Watch;
use crate::insight::prepare::data::Data;
use crate::insight::prepare::flight::PreparedFlight;
use crate::insight::quality::Quality;
use crate::model::vehicle::Vehicle;
use extension::{extend, keep, names, unpaid_forms};
use judgement::diagnosis::{Diagnosis, Residual, Verdict};
use judgement::finding::{Finding, Status};
use judgement::findings::Judgement;
use judgement::judge::Judged;
use judgement::{detectable, doubt, drift, findings, one_motor, parts, set_aside};
use motor_loop::MotorsLate;
use prediction::channels::NAMES;
use prediction::model::Model;
use prediction::motors;
use prediction::problem::Problem;
use prediction::record::{self, FlightRecord};
use rayon::prelude::*;
use selection::Selection;
use selection::fitted::FittedSelection;
use selection::{accident, disambiguate, ordinary, whole};
use std::collections::BTreeMap;

/// Flights and their diagnosis, with all that a report needs.
pub struct Diagnosed {
    /// What was found.
    pub diagnosis: Diagnosis,
    /// The base vehicle with what was found; why there is none where it would be no vehicle, or predict worse.
    pub vehicle: Result<Vehicle, String>,
    /// What changed since earlier flights, where there are such.
    pub changes: Option<against::Changes>,
    #[doc(hidden)]
    pub problem: Problem,
    #[doc(hidden)]
    pub selection: Selection,
}

/// Flights, ready to be held against `vehicle`.
pub fn problem(logs: Vec<Quality>, vehicle: &Vehicle) -> Problem {
    let data = Data::new(logs);
    let one = |f| FlightRecord::new(f, record::full_rate(vehicle, &f.quality));
    let records: Vec<FlightRecord> = data.flights.iter().map(one).collect();
    let begin: Vec<f64> =
        records.iter().map(|r| r.volts.first().map_or(vehicle.battery.full_v, |first| first.1)).collect();
    let mut model = Model::new(vehicle, &begin);
    if records.iter().all(|r| r.from_rotors) {
        model.forget_voltage();
    }
    let late = |f: &PreparedFlight| MotorsLate::new(&f.quality.log, &f.quality.usable);
    let late = data.flights.par_iter().map(late).collect::<Option<_>>().unwrap_or_default();
    Problem { late, ..Problem::new(model, records) }
}

/// Diagnoses flights of a vehicle that is thought to be `vehicle`.
pub fn diagnose(logs: Vec<Quality>, vehicle: &Vehicle, watch: Watch) -> Diagnosed {
    watch("predicting", 0.02);
    let (problem, selection, left_out) = accident::select_steady(logs, |logs| problem(logs, vehicle), watch);
    let mut selection = unpaid_forms::given_up(&problem, selection);
    ordinary::first(&problem, &mut selection);
    whole::parts(&problem, &mut selection);
    disambiguate::clocks(&problem, &mut selection);
    let lost = disambiguate::chance(&problem, &mut selection);
    let (selection, aside) = set_aside::set_aside(&problem, selection);
    watch("judging", 0.85);
    let [structure, before] =
        [&selection.point, &selection.base].map(|p| structure::search(&problem, &p.state, &p.residual));
    let fitted = FittedSelection::new(&problem, &selection);
    let Judgement { mut findings, judged, mut drift, unexplained, small } = findings::find(&fitted, lost, &structure);
    let driven: Vec<motors::Driven> = problem.records.iter().flat_map(|r| r.driven.clone()).collect();
    one_motor::doubt_moves(&driven, &mut findings);
    doubt::all(&fitted, &mut findings);
    findings.extend(aside);
    watch("measuring the gain", 0.9);
    let (kept, worse) = keep::keep(&problem, &selection, &mut findings);
    let fitted_kept = FittedSelection::new(&problem, &kept);
    names::as_written(&fitted_kept, &mut findings);
    one_motor::name(&driven, &mut findings);
    parts::in_common(&problem.late, &mut findings);
    let held = gain::measure(&problem, &selection, &kept);
    gains(&problem, &held, &judged, &mut findings);
    findings.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    let verdict = match (unexplained.is_empty(), findings.is_empty()) {
        (false, _) => Verdict::Unexplained,
        (true, true) => Verdict::Clean,
        (true, false) => Verdict::Effects,
    };
    let (detectable, not_detectable) = detectable::judge(&problem, &selection, &findings);
    let extended = match worse {
        Some(worse) => Err(worse),
        None => extend::vehicle(&fitted_kept, &findings)
            .inspect(|_| drift::written(&mut drift, &problem.model, &kept.point.x)),
    };
    let diagnosis = Diagnosis {
        verdict,
        logs: problem.records.iter().map(|r| r.name.clone()).collect(),
        base: vehicle.name.clone(),
        usable_s: problem.records.iter().map(|r| r.usable_s).sum(),
        left_out,
        findings,
        unexplained,
        small,
        not_detectable,
        detectable,
        drift,
        residuals: residuals(&problem, &selection),
        held_out: held.channels,
        horizons: held.horizons,
        captured: held.captured,
        structure_before: before,
        structure,
        not_extended: extended.as_ref().err().cloned(),
    };
    Diagnosed { diagnosis, vehicle: extended, changes: None, problem, selection }
}

/// What each finding gains on flight that was not used for fitting.
fn gains(problem: &Problem, held: &gain::HeldOut, judged: &[Judged], findings: &mut [Finding]) {
    for finding in findings {
        let one = judged.iter().find(|j| j.finding.effect == finding.effect);
        let all = one.map_or(held.channels.clone(), |j| held.of_one(problem, &j.change, finding.in_vehicle()));
        finding.gain = all.into_iter().filter(|(c, _)| finding.explained.contains_key(c)).collect();
    }
}

/// By impact; what is only suspected comes last.
fn rank(finding: &Finding) -> f64 {
    finding.impact + if finding.status == Status::Suspected { 0.0 } else { 1e6 }
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
