//! Every manoeuvre of the pilot, flown in the simulator in the vehicle as identified, and ready to be predicted.

use super::causes::Question;
use crate::base::check::Check;
use crate::flight::fly::{Flown, FlownManoeuvre, in_order};
use crate::flight::pilot::Manoeuvre;
use crate::flight::planned::FlightPlan;
use crate::flight::sensors::SensorConfig;
use crate::insight::diagnose::prediction::numbers::{BEGIN, span};
use crate::insight::diagnose::prediction::problem::{Problem, ResidualRow};
use crate::insight::diagnose::{Diagnosed, problem};
use crate::insight::quality::check;
use crate::model::effects::MODEL;
use crate::model::vehicle::Vehicle;

/// How often each kind is flown, at full size and smaller, to both sides.
const TIMES: usize = 2;
/// Manoeuvres of one flight: no more than a pack carries.
const A_FLIGHT: usize = 10;
/// What one takes at most, s, and take-off and landing.
const EACH_S: f64 = 14.0;
const AROUND_S: f64 = 40.0;
/// A manoeuvre is told by stretches of at most this length, s: that of a diagnosis.
const PIECE_S: f64 = 2.0;
/// Where the pilot's random numbers start.
const SEED: u64 = 0x9_1a4;

/// What is flown in a stretch of time: a kind, by its place among [`ManoeuvreFlights::kinds`], or take-off and landing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PieceOf {
    Kind(usize),
    Around,
    /// Take-offs and landings of further flights, which are flown once only.
    Nothing,
}

/// A kind that was flown.
#[derive(Clone, Copy, Debug)]
pub struct FlownKind {
    pub kind: Manoeuvre,
    /// How often.
    pub times: usize,
    /// What one takes with its approach, s.
    pub seconds: f64,
}

/// See the module.
pub struct ManoeuvreFlights {
    pub problem: Problem,
    pub kinds: Vec<FlownKind>,
    /// What each stretch of time is of.
    pub pieces: Vec<PieceOf>,
    /// Stretch of each row of each channel.
    pub stretches: Vec<Vec<u32>>,
    /// Take-off and landing, s.
    pub around_s: f64,
    vehicle: Vehicle,
}

impl ManoeuvreFlights {
    /// Flies every kind in the vehicle that the likeliest cause of `question` makes of `base`.
    pub fn new(diagnosed: &Diagnosed, question: &Question, base: &Vehicle) -> Self {
        let likeliest = question.causes.iter().find(|cause| cause.card.is_some()).unwrap_or(&question.causes[0]);
        let vehicle = as_identified(diagnosed, &likeliest.x).unwrap_or(base.clone());
        let order = FlightPlan::new(Manoeuvre::ALL.into_iter().map(|kind| (kind, TIMES))).order();
        // Sensors without errors: what they add is known from the flights so far.
        let sensors = SensorConfig::ideal();
        let seconds = AROUND_S + EACH_S * A_FLIGHT as f64;
        let flights: Vec<_> = order
            .chunks(A_FLIGHT)
            .zip(SEED..)
            .map(|(chunk, seed)| in_order(&vehicle, &sensors, chunk, seed, seconds))
            .collect();
        let around = |(flown, manoeuvres): &(Flown, Vec<FlownManoeuvre>)| {
            flown.seconds - manoeuvres.iter().map(|m| m.span_s[1] - m.span_s[0]).sum::<f64>()
        };
        let around_s = flights.first().map_or(0.0, around);
        let (logs, manoeuvres): (Vec<_>, Vec<_>) =
            flights.into_iter().map(|(flown, manoeuvres)| (check(&flown.log), manoeuvres)).unzip();
        let problem = problem(logs, base);
        let kinds: Vec<FlownKind> = Manoeuvre::ALL.into_iter().filter_map(|kind| flown(kind, &manoeuvres)).collect();
        let mut out = Self { problem, kinds, pieces: Vec::new(), stretches: Vec::new(), around_s, vehicle };
        out.divide(&manoeuvres);
        out
    }

    /// Divides every manoeuvre into stretches, and finds that of each row.
    fn divide(&mut self, flights: &[Vec<FlownManoeuvre>]) {
        let mut spans: Vec<Vec<([f64; 2], u32)>> = Vec::new();
        // The first two are of take-offs and landings.
        self.pieces = vec![PieceOf::Around, PieceOf::Nothing];
        for manoeuvres in flights {
            let mut of_flight = Vec::new();
            for m in manoeuvres {
                let Some(place) = self.kinds.iter().position(|k| k.kind == m.kind) else { continue };
                let [from, to] = m.span_s;
                let count = ((to - from) / PIECE_S).ceil().max(1.0);
                let length = (to - from) / count;
                for i in 0..count as usize {
                    let begin = from + i as f64 * length;
                    of_flight.push(([begin, begin + length], self.pieces.len() as u32));
                    self.pieces.push(PieceOf::Kind(place));
                }
            }
            spans.push(of_flight);
        }
        let records = &self.problem.records;
        let of = |flight: usize, time: f64| {
            let spans = &spans[flight];
            let last = spans.partition_point(|(span, _)| span[0] <= time).checked_sub(1).map(|i| spans[i]);
            last.filter(|(span, _)| time < span[1]).map_or(u32::from(flight > 0), |(_, piece)| piece)
        };
        let rows = self.problem.rows.iter();
        self.stretches = rows
            .map(|rows| {
                let one = |row: &ResidualRow| {
                    let flight = row.flight as usize;
                    of(flight, records[flight].time[row.sample as usize])
                };
                rows.iter().map(one).collect()
            })
            .collect();
    }

    /// The length of a planned flight, s, and how many of its manoeuvres are flown before the battery is empty.
    pub fn flown(&self, plan: &FlightPlan) -> (f64, usize) {
        let (flown, manoeuvres) = in_order(&self.vehicle, &SensorConfig::ideal(), &plan.order(), SEED, plan.enough_s());
        (flown.seconds, manoeuvres.len())
    }

    /// The numbers `x` of the flights so far, for these.
    pub fn numbers(&self, x: &[f64]) -> Vec<f64> {
        x[..BEGIN].iter().chain(&self.problem.model.base[BEGIN..]).copied().collect()
    }
}

/// How often a kind was flown, and how long it takes; none where it was not.
fn flown(kind: Manoeuvre, flights: &[Vec<FlownManoeuvre>]) -> Option<FlownKind> {
    let of = || flights.iter().flatten().filter(|m| m.kind == kind);
    let times = of().count();
    let seconds = of().map(|m| m.span_s[1] - m.span_s[0]).sum::<f64>() / times.max(1) as f64;
    (times > 0).then_some(FlownKind { kind, times, seconds })
}

/// The vehicle at `x`, with the effects of the simulator that are there; none where it could not fly.
fn as_identified(diagnosed: &Diagnosed, x: &[f64]) -> Option<Vehicle> {
    let mut vehicle = diagnosed.problem.model.vehicle_at(x);
    for card in MODEL {
        if span(card).any(|k| x[k] != 0.0) {
            let sizes = card.parameters.iter().zip(span(card));
            sizes.for_each(|(p, k)| vehicle.effects.put(card.id, p.name, x[k], 0.0));
        }
    }
    vehicle.check().is_ok().then_some(vehicle)
}
