//! The excitation pilot: flies short manoeuvres that together show a vehicle's response, thrust, drag and battery.
//!
//! It rests on the ground, takes off, then by turns flies to where a manoeuvre begins and flies it, until it lands. The
//! manoeuvres come in rounds of random order, so that each is flown at high and at low voltage. It knows a vehicle by
//! its limits only, and keeps within [`bounds`].

pub mod bounds;
mod cascade;
mod deck;
pub mod manoeuvre;
mod phase;
mod plan;
mod script;
mod view;
mod words;

use crate::base::rng::{Philox, RngStream, Sequence};
use cascade::Cascade;
use deck::Deck;
pub use manoeuvre::Manoeuvre;
use nalgebra::Vector3;
use phase::PilotPhase;
use plan::Plan;
use script::Now;
use view::View;

/// What the pilot sees: position (m) and velocity (m/s) in the world, attitude (body to world, w x y z), body rates
/// (rad/s), voltage (V).
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub time_s: f64,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub attitude: [f64; 4],
    pub rates: [f64; 3],
    pub voltage: f64,
}

/// What the pilot knows of the vehicle and the flight.
#[derive(Clone, Copy, Debug)]
pub struct PilotLimits {
    /// Body rates at full stick, rad/s.
    pub max_rate_rad_s: [f64; 3],
    /// Thrust command that about carries the vehicle, -1..1.
    pub hover_command: f64,
    /// When it is to be back on the ground, s.
    pub seconds: f64,
    /// Voltage at which it lands earlier, V.
    pub empty_v: f64,
}

/// Length from which a flight is long, s.
const LONG_S: f64 = 200.0;

/// See the module.
#[derive(Debug)]
pub struct Pilot {
    limits: PilotLimits,
    deck: Deck,
    /// What was begun, approach and all, and when, s.
    begun: Vec<(Manoeuvre, f64)>,
    /// When it began to land, s.
    landing_s: Option<f64>,
    rng: Sequence,
    cascade: Cascade,
    /// Where the first command was asked for: the origin of its box.
    origin: Option<Vector3<f64>>,
    phase: PilotPhase,
    /// Since when, s.
    since: f64,
    before: f64,
}

impl Pilot {
    /// A pilot that flies all kinds of manoeuvres, but for the low hover in a short flight; `seed` decides their order
    /// and sizes.
    pub fn new(seed: u64, limits: PilotLimits) -> Self {
        Self {
            limits,
            // A low hover shows nothing but the ground effect: a short flight has no time for it.
            deck: Deck::rounds(
                Manoeuvre::ALL
                    .into_iter()
                    .filter(|kind| limits.seconds > LONG_S || *kind != Manoeuvre::LowHover)
                    .collect(),
            ),
            begun: Vec::new(),
            landing_s: None,
            rng: Philox::new(seed).sequence(RngStream::Pilot, 0, 0),
            cascade: Cascade::new(&limits),
            origin: None,
            phase: PilotPhase::Ground,
            since: 0.0,
            before: f64::NEG_INFINITY,
        }
    }

    /// Flies `kinds` only; all of them where none is named.
    pub fn only(mut self, kinds: &[Manoeuvre]) -> Self {
        if !kinds.is_empty() {
            self.deck = Deck::rounds(kinds.to_vec());
        }
        self
    }

    /// Flies exactly these, in this order, and lands; earlier where time or battery are over before.
    pub fn in_order(mut self, order: &[Manoeuvre]) -> Self {
        self.deck = Deck::once(order);
        self
    }

    /// What was begun so far: the kinds, and when the approach to each began, s.
    pub fn begun(&self) -> &[(Manoeuvre, f64)] {
        &self.begun
    }

    /// When it began to land, s.
    pub fn landing_s(&self) -> Option<f64> {
        self.landing_s
    }

    /// The command for the next 10 ms: roll, pitch, yaw rate and thrust, each in [-1, 1].
    pub fn command(&mut self, seen: &Seen) -> [f64; 4] {
        if self.origin.is_none() {
            self.since = seen.time_s;
        }
        let origin = *self.origin.get_or_insert(Vector3::from(seen.position));
        let view = View::new(seen, origin);
        let dt = (seen.time_s - self.before).clamp(0.0, 0.1);
        self.before = seen.time_s;
        loop {
            let time = seen.time_s - self.since;
            let now = Now { time, dt, view: &view, limits: &self.limits };
            if let Some(demand) = self.phase.demand(&now, &mut self.rng) {
                return match demand {
                    Some(demand) => self.cascade.command(&view, &demand, dt),
                    None => [0.0, 0.0, 0.0, -1.0],
                };
            }
            self.phase = self.next(&view);
            self.since = seen.time_s;
        }
    }

    /// Whether it is back on the ground for good.
    pub fn landed(&self) -> bool {
        matches!(self.phase, PilotPhase::Landed)
    }

    /// The phase after this one.
    fn next(&mut self, view: &View) -> PilotPhase {
        let over = phase::is_over(view, &self.limits);
        let next = match std::mem::replace(&mut self.phase, PilotPhase::Landed) {
            PilotPhase::Ground => PilotPhase::TakeOff,
            PilotPhase::Landing | PilotPhase::Landed => PilotPhase::Landed,
            _ if over => PilotPhase::Landing,
            PilotPhase::Approach(plan) => PilotPhase::Manoeuvre(plan),
            PilotPhase::TakeOff | PilotPhase::Manoeuvre(_) => {
                self.cascade.settle();
                self.plan(view).map_or(PilotPhase::Landing, PilotPhase::Approach)
            }
        };
        if matches!(next, PilotPhase::Landing) {
            self.landing_s = Some(view.time);
        }
        next
    }

    /// The next manoeuvre; none where all are flown.
    fn plan(&mut self, view: &View) -> Option<Plan> {
        let kind = self.deck.next(&mut self.rng)?;
        let before = self.begun.iter().filter(|(other, _)| *other == kind).count();
        self.begun.push((kind, view.time));
        Some(Plan::new(kind, before, view, &self.limits, &mut self.rng))
    }
}
