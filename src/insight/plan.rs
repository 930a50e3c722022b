//! The next flight: the shortest one whose simulation tells the causes apart that the flights so far do not.
//!
//! Causes that are tied take each other's place in the fit ([`causes`]). Every manoeuvre of the pilot is flown in the
//! simulator, in the vehicle as identified ([`simulate`]). What two causes would leave of each other there, with all
//! other numbers free to make up for it, by stretch of time, is what the manoeuvre tells ([`separation`]). Manoeuvres
//! are added by what they tell a second until all is told, and taken away again where it stays told ([`choose`]).

mod causes;
mod choose;
mod columns;
mod pair;
mod separation;
mod simulate;
mod unseen;

use super::Watch;
use super::criteria::planned::LONGEST_PLAN_S;
use super::diagnose::Diagnosed;
use crate::flight::pilot::Manoeuvre;
use crate::flight::planned::FlightPlan;
use crate::model::vehicle::Vehicle;
use causes::Question;
use choose::Choice;
use pair::CausePair;
use serde::Serialize;
use simulate::ManoeuvreFlights;

/// What to fly next, and what it is expected to tell.
#[derive(Clone, Debug, Default, Serialize)]
pub struct NextFlight {
    /// Whether causes are tied; else it is planned for what the flights so far could not show.
    pub tied: bool,
    /// What is to be told from what.
    pub pairs: Vec<PlannedPair>,
    /// What is flown, the most useful first; nothing where there is nothing to tell, or no manoeuvre tells it.
    pub manoeuvres: Vec<ChosenManoeuvre>,
    /// Length with take-off and landing, s.
    pub seconds: f64,
    /// Manoeuvres that are flown before the battery is empty.
    pub on_a_pack: usize,
    /// Findings that may be several causes, and that no manoeuvre is planned for: only the move of thrust and drag
    /// against the base vehicle shows them.
    pub left_out: Vec<&'static str>,
}

/// Two causes, in standard deviations of their difference over stretches of time.
#[derive(Clone, Debug, Serialize)]
pub struct PlannedPair {
    /// Identifiers; no second one where the question is whether the first is there at all.
    pub causes: [Option<&'static str>; 2],
    /// What the flights so far would tell of them on the average of all noise.
    pub now: f64,
    /// The same of the planned flight, by itself and together with them, whichever is less.
    pub then: f64,
    /// What is wanted.
    pub wanted: f64,
    /// Why no flight of the pilot's manoeuvres tells it, where none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<&'static str>,
}

/// A manoeuvre of the planned flight.
#[derive(Clone, Debug, Serialize)]
pub struct ChosenManoeuvre {
    /// As the pilot knows it.
    pub name: &'static str,
    /// How often.
    pub count: usize,
    /// What one takes with its approach, s.
    pub each_s: f64,
    /// What a person flies.
    pub words: &'static str,
}

impl NextFlight {
    /// As a file for the pilot; none where nothing is to be flown.
    pub fn file(&self) -> Option<FlightPlan> {
        let one = |chosen: &ChosenManoeuvre| Some((Manoeuvre::named(chosen.name)?, chosen.count));
        (!self.manoeuvres.is_empty()).then(|| FlightPlan::new(self.manoeuvres.iter().filter_map(one)))
    }

    /// Takes over what was chosen, in names.
    fn choose(&mut self, question: &Question, pairs: &[CausePair], choice: &Choice, simulation: &ManoeuvreFlights) {
        let flown = choice.counts.iter().any(|count| *count > 0.0);
        let one = |(pair, tells): (&CausePair, &bool)| PlannedPair {
            causes: pair.causes.map(|i| question.causes[i].card.map(|card| card.id)),
            now: pair.so_far(),
            then: if flown { pair.planned(&choice.counts) } else { 0.0 },
            wanted: pair.wanted,
            why_not: (!tells).then(|| pair.why_not(simulation.kinds.len())),
        };
        let of = |(kind, count): (&simulate::FlownKind, &f64)| ChosenManoeuvre {
            name: kind.kind.name(),
            count: *count as usize,
            each_s: kind.seconds,
            words: kind.kind.words(),
        };
        self.pairs = pairs.iter().zip(&choice.tells).map(one).collect();
        let chosen = simulation.kinds.iter().zip(&choice.counts).filter(|(_, count)| **count > 0.0);
        self.manoeuvres = chosen.map(of).collect();
        self.manoeuvres.sort_by_key(|chosen| usize::MAX - chosen.count);
        if let Some(plan) = self.file() {
            (self.seconds, self.on_a_pack) = simulation.flown(&plan);
            if self.on_a_pack < plan.order().len() {
                self.seconds = choice.seconds;
            }
        }
    }
}

/// Plans the flight that comes after those of `diagnosed`, of a vehicle that is thought to be `vehicle`.
pub fn next_flight(diagnosed: &Diagnosed, vehicle: &Vehicle, watch: Watch) -> NextFlight {
    watch("looking for ties", 0.92);
    let tied = causes::tied(diagnosed);
    let mut next = NextFlight { tied: tied.is_some(), left_out: causes::left_out(diagnosed), ..NextFlight::default() };
    let Some(question) = tied.or_else(|| unseen::question(diagnosed)) else { return next };
    watch("flying every manoeuvre in the simulator", 0.94);
    let simulation = ManoeuvreFlights::new(diagnosed, &question, vehicle);
    watch("choosing manoeuvres", 0.97);
    let pairs = separation::pairs(diagnosed, &question, &simulation);
    let choice = choose::choose(&pairs, &simulation.kinds, simulation.around_s, LONGEST_PLAN_S.get());
    next.choose(&question, &pairs, &choice, &simulation);
    next
}
