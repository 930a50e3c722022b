//! A vehicle in flight, or 16: its state, and the equations that move it. Who flies one need not know which they are.

use super::extended::{self, EffectMemory, Extended};
use super::{Factors, Parameters, State, specific_force, step};
use crate::base::lane::{Lane, Real};
use crate::model::vehicle::Vehicle;

/// A state and what moves it.
#[derive(Clone, Debug)]
pub struct Craft<R> {
    pub state: State<R>,
    equations: Equations<R>,
}

/// The compact model, or the one with effects. The latter lies apart, so that a compact vehicle neither holds nor moves
/// any of it.
#[derive(Clone, Debug)]
enum Equations<R> {
    Compact(Parameters<R>),
    Extended(Box<(Extended<R>, EffectMemory<R>)>),
}

impl Craft<f64> {
    /// `vehicle` with `factors` in `state`, for steps of `dt` seconds; its command was held before.
    pub fn new(vehicle: &Vehicle, factors: &Factors, dt: f64, state: State<f64>) -> Self {
        let equations = if vehicle.effects.is_empty() {
            Equations::Compact(Parameters::new(vehicle, factors, dt))
        } else {
            Equations::Extended(Box::new((Extended::new(vehicle, factors, dt), EffectMemory::before(state.command))))
        };
        Craft { state, equations }
    }
}

impl<R> Craft<R> {
    /// The compact model's share of the equations.
    #[inline(always)]
    pub fn parameters(&self) -> &Parameters<R> {
        match &self.equations {
            Equations::Compact(p) => p,
            Equations::Extended(e) => &e.0.compact,
        }
    }

    /// Whether effects beyond the compact model act.
    pub fn is_extended(&self) -> bool {
        matches!(self.equations, Equations::Extended(_))
    }

    /// The effects' numbers and what they remember, if there are effects: for tests.
    #[cfg(feature = "internals")]
    pub fn extension(&mut self) -> Option<&mut (Extended<R>, EffectMemory<R>)> {
        match &mut self.equations {
            Equations::Compact(_) => None,
            Equations::Extended(e) => Some(e),
        }
    }
}

impl<R: Copy> Craft<R> {
    /// Converts every number, in a fixed order.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> Craft<S> {
        let state = self.state.map(&mut f);
        let equations = match &self.equations {
            Equations::Compact(p) => Equations::Compact(p.map(f)),
            Equations::Extended(e) => Equations::Extended(Box::new((e.0.map(&mut f), e.1.map(f)))),
        };
        Craft { state, equations }
    }

    /// Goes on from where `other`, which obeys the same kind of equations, is, with its own parameters. Every number is
    /// converted.
    #[inline(always)]
    pub fn resume<S: Copy>(&mut self, other: &Craft<S>, mut f: impl FnMut(S) -> R) {
        self.state = other.state.map(&mut f);
        if let (Equations::Extended(own), Equations::Extended(other)) = (&mut self.equations, &other.equations) {
            own.1 = other.1.map(f);
        }
    }
}

impl<L: Lane> Craft<L> {
    /// Replaces one lane.
    ///
    /// # Panics
    /// If one has effects and the other has none: a block obeys one kind of equations.
    pub fn set_lane(&mut self, lane: usize, new: &Craft<L::Elem>) {
        self.state.set_lane(lane, &new.state);
        match (&mut self.equations, &new.equations) {
            (Equations::Compact(own), Equations::Compact(new)) => own.set_lane(lane, new),
            (Equations::Extended(own), Equations::Extended(new)) => {
                own.0.set_lane(lane, &new.0);
                own.1.set_lane(lane, &new.1);
            }
            _ => panic!("a vehicle with effects and one without in one block"),
        }
    }
}

impl<R: Real> Craft<R> {
    /// One step under the held command `action`.
    #[inline(always)]
    pub fn step(&mut self, action: [R; 4]) {
        match &mut self.equations {
            Equations::Compact(p) => step(&mut self.state, p, action),
            Equations::Extended(e) => extended::step(&mut self.state, &e.0, &mut e.1, action),
        }
    }

    /// Body rates, rad/s, body frame.
    #[inline(always)]
    pub fn body_rates(&self) -> [R; 3] {
        match &self.equations {
            Equations::Compact(p) => self.state.body_rates(p),
            Equations::Extended(e) => extended::body_rates(&e.0, self.state.command),
        }
    }

    /// Voltage at the battery's terminals, V.
    #[inline(always)]
    pub fn terminal_voltage(&self) -> R {
        match &self.equations {
            Equations::Compact(_) => self.state.voltage,
            Equations::Extended(e) => extended::loaded(&self.state, &e.0, &e.1),
        }
    }

    /// Thrust and drag over the mass, body frame, m/s2: what an accelerometer at the centre of mass measures.
    #[inline(always)]
    pub fn specific_force(&self) -> [R; 3] {
        match &self.equations {
            Equations::Compact(p) => specific_force(&self.state, p),
            Equations::Extended(e) => extended::specific_force(&self.state, &e.0, &e.1),
        }
    }
}
