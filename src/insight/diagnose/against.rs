//! What changed between two sets of flights of one vehicle.
//!
//! All flights are fitted as one vehicle's, with the effects that they show together ([`super::selection`]). Then each
//! number of the compact model and each effect may differ between the sets ([`suspect`]); a score test ranks the
//! differences beside the same cause in both sets ([`columns`]), the best are fitted ([`search`]) and judged
//! ([`judge`]). What the model gets wrong of both sets alike is no difference.

mod alike;
pub mod by_motors;
mod change;
mod clock;
mod columns;
mod flown;
mod judge;
mod motor;
mod part;
mod search;
mod shaken;
mod sizes;
mod stamped;
mod suspect;
mod untold;
mod would_show;

use crate::insight::Watch;
use crate::insight::diagnose::fitting::size::is_material;
use crate::insight::diagnose::judgement::diagnosis::Diagnosis;
use crate::insight::diagnose::judgement::finding::Status;
use crate::insight::diagnose::judgement::shown;
use crate::insight::diagnose::motor_loop::{MotorLoop, motor_loop, together};
use crate::insight::diagnose::prediction::contrast::Contrast;
use crate::insight::diagnose::prediction::numbers::DISCHARGE;
use crate::insight::diagnose::prediction::problem::Problem;
use crate::insight::diagnose::selection::Selection;
use crate::insight::diagnose::selection::accident;
use crate::insight::diagnose::selection::fitted::FittedSelection;
use crate::insight::quality::Quality;
use crate::model::effects::{self, EffectKind, Role};
use crate::model::vehicle::Vehicle;
pub use change::{Both, Change, Changes, WouldShow};
use rayon::prelude::*;
use search::DifferenceSearch;
use suspect::{FoundDifference, Suspect};

/// What changed from the flights `before` to the flights `after`, of a vehicle that is thought to be `vehicle`.
pub fn compare(before: Vec<Quality>, after: Vec<Quality>, vehicle: &Vehicle, watch: Watch) -> Changes {
    let later: Vec<bool> = before.iter().map(|_| false).chain(after.iter().map(|_| true)).collect();
    let all: Vec<Quality> = before.into_iter().chain(after).collect();
    let loops = all.par_iter().map(|q| motor_loop(&q.log, &q.usable)).collect::<Vec<_>>();
    let (earlier, last) = loops.split_at(later.iter().filter(|later| !**later).count());
    let loops = together(earlier).zip(together(last)).map(|(before, after)| [before, after]);
    let contrasted = |logs| {
        let mut problem = super::problem(logs, vehicle);
        // That a late gyro undoes what moved the odometry to it would be a jump between one set and the other; each
        // set's odometry is moved in every fit anyway.
        let moved = problem.records.iter_mut().map(|record| std::mem::take(&mut record.moved)).collect();
        problem.contrast = Some(Contrast::new(&mut problem.model, later.clone(), moved));
        problem
    };
    let (problem, selection, left_out) =
        accident::select_steady(all, contrasted, &mut |step, share| watch(step, 0.5 * share));
    let suspects = suspect::known(&problem);
    watch("comparing", 0.5);
    let selection = Selection { whitener: alike::deaf(&problem, &selection), ..selection };
    let search = DifferenceSearch::new(&problem, &suspects, selection).run();
    let would_show = would_show::all(&problem, &search.tested, &suspects);
    Changes { would_show, left_out, ..changes(&problem, &suspects, &search, loops.as_ref()) }
}

impl Changes {
    /// Of what both sets show alike, only what the later flights name by themselves.
    pub fn confirm(&mut self, later: &Diagnosis) {
        let named = |id: &str| later.findings.iter().any(|f| f.effect == id && f.status != Status::Suspected);
        self.both.retain(|both| named(both.effect));
    }
}

/// Differences that every fit allows for. How far a pack falls is told with what else it does otherwise.
fn allowed(search: &DifferenceSearch, suspects: &[Suspect]) -> Vec<FoundDifference> {
    let known = |suspect: usize| search.found.iter().any(|f| f.suspect == suspect);
    let own = |s: &Suspect| !s.own.is_empty() && s.own.iter().all(|k| search.selection.point.free.contains(k));
    let of_pack = |s: &Suspect| s.card.is_some_and(|card| card.kind == EffectKind::Battery);
    let another_pack = search.found.iter().any(|f| of_pack(&suspects[f.suspect]));
    let told = |s: &Suspect| another_pack && s.numbers.contains(&DISCHARGE);
    let allowed = (0..suspects.len()).filter(|&s| !known(s) && own(&suspects[s]) && !told(&suspects[s]));
    allowed.map(|suspect| FoundDifference { suspect, ties: Vec::new() }).collect()
}

/// The answer.
fn changes(
    problem: &Problem,
    suspects: &[Suspect],
    search: &DifferenceSearch,
    loops: Option<&[MotorLoop; 2]>,
) -> Changes {
    let fitted = &FittedSelection::new(problem, &search.selection);
    let x = &fitted.point().x;
    let mut changes = judge::all(fitted, suspects, &search.found);
    changes.extend(search.rejected.iter().cloned());
    // What every fit allows for is worth a word where it is named.
    let allowed = judge::all(fitted, suspects, &allowed(search, suspects));
    changes.extend(allowed.into_iter().filter(|change| change.status != Status::Suspected));
    if let Some(motor) = motor::find(problem) {
        changes.retain(|c| c.cause != motor.cause);
        changes.push(motor);
    }
    if let Some(loops) = loops {
        by_motors::add(loops, &mut changes);
    }
    clock::doubt(problem, &mut changes);
    stamped::tell(problem, x, &mut changes);
    shaken::tell(&mut changes);
    untold::tell(&mut changes);
    // Constant errors of sensors and clocks are others after every switching on: what the vehicle does comes first, the
    // surest of it before all, told from all others or not.
    let own = [Role::ConstantError, Role::ClockFast];
    let constant = |c: &Change| effects::card(c.cause).is_some_and(|card| own.contains(&card.role));
    let place = |c: &Change| match c.status {
        Status::Suspected => 0.0,
        _ if constant(c) => 1e9,
        _ => 2e9,
    };
    let rank = |c: &Change| c.deviations + place(c);
    changes.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    let named = |id: &str| changes.iter().any(|c| c.cause == id && c.status != Status::Suspected);
    let alike = fitted.selection.added.iter().filter(|a| !named(a.card.id) && is_material(a.card, x));
    let both = alike
        .map(|a| Both { effect: a.card.id, name: a.card.name, parameters: shown::parameters(fitted, a.card) })
        .collect();
    let changed = changes.iter().any(|c| c.status != Status::Suspected);
    let [before, after] = [false, true].map(|set| names(problem, set));
    Changes { changed, before, after, changes, both, would_show: Vec::new(), left_out: Vec::new() }
}

/// Names of the logs of a set.
fn names(problem: &Problem, later: bool) -> Vec<String> {
    let sets = problem.contrast.iter().flat_map(|c| &c.later);
    problem.records.iter().zip(sets).filter(|(_, set)| **set == later).map(|(r, _)| r.name.clone()).collect()
}
