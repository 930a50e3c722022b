//! The vehicle that a diagnosis describes: the compact model's numbers as fitted with its effects, the effects, and how
//! well they are known.

use crate::base::check::Check;
use crate::insight::diagnose::judgement::finding::{Finding, Status};
use crate::insight::diagnose::prediction::numbers::{BEGIN, span};
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::model::effects::{EffectKind, MODEL, Role};
use crate::model::vehicle::Vehicle;
use crate::model::vehicle::extension::Extension;
use std::collections::{BTreeMap, BTreeSet};

/// The base vehicle with the compact model's numbers of a selection. Beside an effect of the battery its voltages are
/// those at rest: a pack that sags is above what was measured under load.
pub fn at_rest(problem: &Problem, selection: &Selection) -> Vehicle {
    let x = &selection.point.x;
    let mut vehicle = problem.model.vehicle_at(x);
    let pack = &mut vehicle.battery;
    if selection.added.iter().any(|a| a.card.kind == EffectKind::Battery) {
        let flights = problem.records.iter().zip(BEGIN..).filter(|(record, _)| !record.volts.is_empty());
        let full_v = flights.map(|(_, k)| x[k]).fold(pack.full_v, f64::max);
        pack.empty_v += full_v - pack.full_v;
        pack.full_v = full_v;
    }
    vehicle
}

/// The base vehicle with every named effect of the simulator, and those that it has itself as they were fitted. Effects
/// of sensors and of chance are no part of a vehicle, nor is the wind, which is the day's; what a change of the compact
/// model's numbers already holds is not added a second time.
///
/// # Errors
///
/// Where it would be no vehicle: what racer writes, racer reads.
pub fn vehicle(fitted: &FittedSelection, findings: &[Finding]) -> Result<Vehicle, String> {
    let point = &fitted.selection.point;
    let mut vehicle = at_rest(fitted.problem, fitted.selection);
    let given = std::mem::take(&mut vehicle.effects);
    let of_day = |f: &Finding| f.has(Role::UniformWind);
    let named = findings.iter().filter(|f| f.status != Status::Suspected && !of_day(f));
    let named = named.flat_map(|f| f.cards().map(|(card, _)| card.id));
    let added = |id: &&str| fitted.selection.added.iter().any(|a| a.card.id == *id);
    let all: BTreeSet<&str> = given.sizes.keys().map(String::as_str).chain(named.filter(added)).collect();
    let mut sizes: BTreeMap<String, BTreeMap<String, f64>> = BTreeMap::new();
    let mut uncertain: Vec<(String, usize)> = Vec::new();
    for card in all.iter().filter_map(|id| MODEL.iter().find(|card| card.id == *id)) {
        for (p, k) in card.parameters.iter().zip(span(card)) {
            sizes.entry(card.id.into()).or_default().insert(p.name.into(), point.x[k]);
            if let Some(place) = point.free.iter().position(|f| *f == k) {
                uncertain.push((format!("{}.{}", card.id, p.name), place));
            }
        }
    }
    // A number at its bound has no spread.
    uncertain.retain(|(_, i)| fitted.covariance[(*i, *i)] > 0.0);
    let row = |i: usize| uncertain.iter().map(|(_, j)| fitted.covariance[(i, *j)]).collect::<Vec<f64>>();
    let covariance = uncertain.iter().map(|(_, i)| row(*i)).collect();
    let logs: Vec<&str> = fitted.problem.records.iter().map(|r| r.name.as_str()).collect();
    let source = format!("racer {} diagnose {}", env!("CARGO_PKG_VERSION"), logs.join(" "));
    if !sizes.is_empty() {
        let uncertain = uncertain.iter().map(|(key, _)| key.clone()).collect();
        vehicle.effects = Extension { source: Some(source), sizes, uncertain, covariance };
        vehicle.effects.known_as(&given);
    }
    match vehicle.check() {
        Ok(()) => Ok(vehicle),
        Err(invalid) => Err(format!(
            "these flights do not tell a vehicle that could fly: {} is {}, expected {}",
            invalid.key, invalid.found, invalid.expected
        )),
    }
}
