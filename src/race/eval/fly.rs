//! Flying a policy's deterministic mean, many agents side by side.

use crate::base::lane::{Kernel, LANES, Lane32, Level, Mask, build, dispatch, sum_of_squares};
use crate::base::rng::{RngStream, Sequence};
use crate::learn::nn::{Network, TILE_BLOCKS, TILE_SAMPLES};
use crate::learn::policy::ACTIONS;
use crate::model::dynamics::Factors;
use crate::race::env::reset::{self, Start, StartPlace};
use crate::race::env::terminate::CAUSES;
use crate::race::env::{Block, Race, lanes};
use rayon::prelude::*;

/// Steps over which commands are judged: the paper's first four seconds.
pub const JUDGED_STEPS: u32 = 400;
/// A command beyond this size counts as saturated (paper section 5.3).
pub const SATURATED: f64 = 0.95;

/// One agent's flight, until it completed a lap, failed, or ran out of steps.
#[derive(Clone, Debug, Default)]
pub struct EvaluatedFlight {
    /// Index of the first target gate.
    pub first_gate: usize,
    /// When each gate was passed, in order, s from the start, interpolated within the step.
    pub passes: Vec<f64>,
    /// Index into [`CAUSES`] of why it failed.
    pub failure: Option<usize>,
    pub top_speed: f64,
    pub steps: u32,
    /// Sum of |a_t - a_(t-1)|^2 and number of terms over the judged steps.
    pub action_change: f64,
    pub changes: u32,
    /// Commands with |a| > 0.95 and commands over the judged steps.
    pub saturated: u32,
    pub commands: u32,
}

impl EvaluatedFlight {
    /// Time from the first crossing of the first gate to the next, on a lap of `gates` gates.
    pub fn lap_time(&self, gates: usize) -> Option<f64> {
        self.passes.get(gates).map(|end| end - self.passes[0])
    }
}

/// One moment of a traced flight.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct TraceStep {
    pub time_s: f64,
    pub x: f32,
    pub y: f32,
    pub z: f32,
    pub vx: f32,
    pub vy: f32,
    pub vz: f32,
    pub qw: f32,
    pub qx: f32,
    pub qy: f32,
    pub qz: f32,
    pub roll: f32,
    pub pitch: f32,
    pub yaw: f32,
    pub thrust: f32,
    pub target_gate: u32,
    pub voltage: f32,
}

/// All agents of one evaluation.
#[derive(Clone, Debug)]
pub struct Flights {
    pub flights: Vec<EvaluatedFlight>,
    /// Agent 0, the nominal vehicle, step by step.
    pub trace: Vec<TraceStep>,
}

/// Which vehicles the agents fly.
#[derive(Clone, Copy, Debug)]
pub enum Fleet<'a> {
    /// The first agent a nominal one, the others with every factor drawn.
    Randomised,
    /// All agents the same: the nominal one with these factors and, at the start, this charge of its battery, 0 to 1.
    Same(&'a Factors, f64),
}

/// Flies `agents` agents from `place` for at most `max_steps` steps; agent 0 is nominal, the others draw every factor.
/// Runs on the current rayon pool; the result does not depend on it.
pub fn fly(
    level: Level,
    race: &Race,
    network: &Network<f32>,
    place: StartPlace,
    agents: usize,
    max_steps: u32,
) -> Flights {
    fly_fleet(level, race, network, place, Fleet::Randomised, agents, max_steps)
}

/// [`fly`] with the vehicles of `fleet`.
pub fn fly_fleet(
    level: Level,
    race: &Race,
    network: &Network<f32>,
    place: StartPlace,
    fleet: Fleet,
    agents: usize,
    max_steps: u32,
) -> Flights {
    let tiles: Vec<_> = (0..agents.div_ceil(TILE_SAMPLES))
        .into_par_iter()
        .map(|tile| dispatch(level, Fly { race, network, place, fleet, first: tile * TILE_SAMPLES, agents, max_steps }))
        .collect();
    let mut all = Flights { flights: Vec::with_capacity(agents), trace: Vec::new() };
    for mut tile in tiles {
        all.flights.append(&mut tile.flights);
        all.trace.append(&mut tile.trace);
    }
    all.flights.truncate(agents);
    all
}

impl Fleet<'_> {
    fn draw(&self, race: &Race, rng: &mut Sequence, place: StartPlace, agent: usize) -> Start {
        match *self {
            Fleet::Randomised => reset::draw(race, rng, place, (agent == 0).then_some(Factors::NOMINAL)),
            Fleet::Same(factors, charge) => {
                let mut start = reset::draw(race, rng, place, Some(*factors));
                start.craft.state.voltage = race.vehicle.battery.at(charge);
                start
            }
        }
    }
}

struct Fly<'a> {
    race: &'a Race,
    network: &'a Network<f32>,
    place: StartPlace,
    fleet: Fleet<'a>,
    first: usize,
    agents: usize,
    max_steps: u32,
}

impl Kernel for Fly<'_> {
    type Output = Flights;

    #[inline(always)]
    fn run<L: Lane32>(self) -> Flights {
        let Fly { race, network, place, fleet, first, agents, max_steps } = self;
        let mut out = Flights { flights: vec![EvaluatedFlight::default(); TILE_SAMPLES], trace: Vec::new() };
        let mut blocks: [Block<L>; TILE_BLOCKS] = std::array::from_fn(|b| race.empty_block((first + b * LANES) as u32));
        // Bits of lanes still flying; padding lanes never start.
        let mut alive = [0u32; TILE_BLOCKS];
        for (b, block) in blocks.iter_mut().enumerate() {
            for lane in 0..LANES {
                let agent = first + b * LANES + lane;
                let mut rng = race.rng.sequence(RngStream::Evaluation, agent as u32, 0);
                let start = fleet.draw(race, &mut rng, place, agent);
                block.begin(race, lane, &start);
                out.flights[b * LANES + lane].first_gate = start.target;
                alive[b] |= u32::from(agent < agents) << lane;
            }
        }
        let mut seen = vec![0.0f32; crate::race::env::observe::OBSERVATIONS * TILE_SAMPLES];
        let mut scratch = network.scratch::<L>();
        let mut mean = [0.0f32; ACTIONS * TILE_SAMPLES];
        for step in 0..max_steps {
            if alive.iter().all(|&bits| bits == 0) {
                break;
            }
            for (b, block) in blocks.iter().enumerate() {
                block.observe(race, &mut seen[b * LANES..], TILE_SAMPLES);
            }
            network.forward_actor::<L>(&seen, &mut scratch, &mut mean);
            for (b, block) in blocks.iter_mut().enumerate() {
                let action: [L; ACTIONS] = build!(|k| L::from_slice(&mean[k * TILE_SAMPLES + b * LANES..]).tanh());
                if first == 0 && b == 0 && alive[0] & 1 == 1 {
                    out.trace.push(moment(block, action, f64::from(step) * race.dt));
                }
                let flights = &mut out.flights[b * LANES..(b + 1) * LANES];
                if step < JUDGED_STEPS {
                    judge(flights, alive[b], action, block.history[0], step);
                }
                let outcome = block.step(race, action);
                let speed = sum_of_squares(block.craft.state.velocity).sqrt();
                for lane in lanes(alive[b]) {
                    let flight = &mut flights[lane];
                    flight.steps = step + 1;
                    flight.top_speed = flight.top_speed.max(f64::from(speed.get(lane)));
                    if outcome.passed >> lane & 1 == 1 {
                        flight.passes.push((f64::from(step) + f64::from(outcome.fraction.get(lane))) * race.dt);
                    }
                    flight.failure = (0..CAUSES.len()).find(|&c| outcome.causes[c] >> lane & 1 == 1);
                    if flight.failure.is_some() || flight.passes.len() > race.gates.len() {
                        alive[b] &= !(1 << lane);
                    }
                }
                // Flights that are over hover at the origin, so that no lane computes with garbage.
                park(block, !alive[b]);
            }
        }
        out
    }
}

/// Adds one step's commands to the flights that are `alive`.
#[inline(always)]
fn judge<L: Lane32>(
    flights: &mut [EvaluatedFlight],
    alive: u32,
    action: [L; ACTIONS],
    before: [L; ACTIONS],
    step: u32,
) {
    let mut change = L::zero();
    let mut saturated = L::zero();
    for k in 0..ACTIONS {
        let d = action[k] - before[k];
        change = d.mul_add(d, change);
        saturated = saturated + L::select(L::of(SATURATED).lt(action[k].abs()), L::one(), L::zero());
    }
    for lane in lanes(alive) {
        let flight = &mut flights[lane];
        flight.commands += ACTIONS as u32;
        flight.saturated += saturated.get(lane) as u32;
        // The first step has no command before it.
        if step > 0 {
            flight.action_change += f64::from(change.get(lane));
            flight.changes += 1;
        }
    }
}

#[inline(always)]
fn park<L: Lane32>(block: &mut Block<L>, over: u32) {
    let over = L::Mask::from_bits(over);
    for v in block.craft.state.position.iter_mut().chain(&mut block.craft.state.velocity) {
        *v = L::select(over, L::zero(), *v);
    }
}

fn moment<L: Lane32>(block: &Block<L>, action: [L; ACTIONS], time_s: f64) -> TraceStep {
    let [x, y, z] = block.craft.state.position.map(|v| v.get(0));
    let [vx, vy, vz] = block.craft.state.velocity.map(|v| v.get(0));
    let [qw, qx, qy, qz] = block.craft.state.attitude.map(|v| v.get(0));
    let [roll, pitch, yaw, thrust] = action.map(|v| v.get(0));
    let (target_gate, voltage) = (block.target[0], block.craft.terminal_voltage().get(0));
    TraceStep { time_s, x, y, z, vx, vy, vz, qw, qx, qy, qz, roll, pitch, yaw, thrust, target_gate, voltage }
}
