//! A policy races in the independent simulator: it sees what is true there, and commands at 100 Hz.

use crate::args::Args;
use crate::truth::CONTROL_S;
use crate::truths::{Flown, Truth};
use nalgebra::Vector3;
use racer::base::lane::{LANES, Lane, Level, Portable};
use racer::flight::pilot::Seen;
use racer::learn::nn::{TILE_BLOCKS, TILE_SAMPLES};
use racer::learn::policy::ACTIONS;
use racer::model::dynamics::State;
use racer::model::vehicle::Vehicle;
use racer::race::env::gates::{GateFrame, crossing};
use racer::race::env::observe::OBSERVATIONS;
use racer::race::env::reset::StartPlace;
use racer::race::env::{Block, Race};
use racer::race::eval::fly::fly;
use racer::race::snapshot::Snapshot;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

/// What all blocks here are made of: speed does not matter.
type L = Portable<f32>;

/// Longest race, s.
const LONGEST_S: f64 = 20.0;
/// Spread of the starts: standard deviations of the place, m, and of the heading, deg; lowest charge.
const PLACE_M: f64 = 0.1;
const HEADING_DEG: f64 = 5.0;
const LEAST_CHARGE: f64 = 0.3;

/// How a race went.
#[derive(Clone, Debug)]
pub struct Raced {
    /// From the first crossing of the first gate to the next, s.
    pub lap_s: Option<f64>,
    /// Why there is none.
    pub failure: Option<&'static str>,
    /// Position, m, and velocity, m/s, at each step.
    pub path: Vec<[f64; 6]>,
}

/// Races of `policy` in `world`; the first is nominal.
pub fn race(policy: &Snapshot, world: &dyn Truth, args: &Args) -> Vec<Raced> {
    let about = &policy.about;
    // What is seen is the truth: nothing of the effects that the policy was trained with takes part in it.
    let plain = Vehicle { effects: Default::default(), ..about.vehicle.clone() };
    let race = Race::new(&about.env, &about.track, &plain, about.seed).scored(&about.track);
    let agents: Vec<u32> = (0..args.agents).collect();
    agents.chunks(TILE_SAMPLES).flat_map(|tile| race_tile(policy, &race, world, tile)).collect()
}

/// The nominal agent's race in racer's own simulator.
pub fn in_racer(policy: &Snapshot) -> Raced {
    let about = &policy.about;
    let race = Race::new(&about.env, &about.track, &about.vehicle, about.seed).scored(&about.track);
    let steps = (LONGEST_S / CONTROL_S) as u32;
    let flights = fly(Level::best(), &race, &policy.network, StartPlace::Pad, 1, steps);
    // The first moment is the start itself.
    let path = flights.trace.iter().skip(1).map(|m| [m.x, m.y, m.z, m.vx, m.vy, m.vz].map(f64::from)).collect();
    Raced { lap_s: flights.flights[0].lap_time(race.gates.len()), failure: None, path }
}

fn race_tile(policy: &Snapshot, race: &Race, world: &dyn Truth, numbers: &[u32]) -> Vec<Raced> {
    let mut agents: Vec<Agent> = numbers.iter().map(|&number| Agent::new(race, world, number)).collect();
    let mut blocks: [Block<L>; TILE_BLOCKS] = std::array::from_fn(|b| race.empty_block((b * LANES) as u32));
    let mut seen = vec![0.0f32; OBSERVATIONS * TILE_SAMPLES];
    let mut scratch = policy.network.scratch::<L>();
    let mut mean = [0.0f32; ACTIONS * TILE_SAMPLES];
    while agents.iter().any(|agent| agent.ended.is_none()) {
        for (i, agent) in agents.iter().enumerate().filter(|(_, agent)| agent.ended.is_none()) {
            agent.show(race, &mut blocks[i / LANES], i % LANES);
        }
        for (b, block) in blocks.iter().enumerate() {
            block.observe(race, &mut seen[b * LANES..], TILE_SAMPLES);
        }
        policy.network.forward_actor::<L>(&seen, &mut scratch, &mut mean);
        for (i, agent) in agents.iter_mut().enumerate().filter(|(_, agent)| agent.ended.is_none()) {
            agent.step(race, std::array::from_fn(|k| mean[k * TILE_SAMPLES + i].tanh()));
        }
    }
    agents.into_iter().filter_map(|agent| agent.ended).collect()
}

struct Agent<'a> {
    flight: Box<dyn Flown + 'a>,
    /// The last three actions, newest first.
    history: [[f32; ACTIONS]; 3],
    target: usize,
    steps: usize,
    /// When each gate was passed, in steps.
    passes: Vec<f64>,
    path: Vec<[f64; 6]>,
    ended: Option<Raced>,
}

impl<'a> Agent<'a> {
    fn new(race: &Race, world: &'a dyn Truth, number: u32) -> Self {
        let mut rng = StdRng::seed_from_u64(u64::from(number));
        let mut normal = |sd: f64| if number == 0 { 0.0 } else { sd * rng.sample::<f64, _>(StandardNormal) };
        let place = race.start.position() + Vector3::new(normal(PLACE_M), normal(PLACE_M), 0.0);
        let heading = race.start.heading_rad() + normal(HEADING_DEG.to_radians());
        let charge = if number == 0 { 1.0 } else { rng.random_range(LEAST_CHARGE..1.0) };
        Agent {
            flight: world.begin(place, heading, charge, u64::from(number)),
            history: [[0.0, 0.0, 0.0, -1.0]; 3],
            target: 0,
            steps: 0,
            passes: Vec::new(),
            path: Vec::new(),
            ended: None,
        }
    }

    fn gate(&self, race: &Race) -> GateFrame<f64> {
        race.gates[self.target].map(f64::from)
    }

    /// Makes `lane` of `block` what is true.
    fn show(&self, race: &Race, block: &mut Block<L>, lane: usize) {
        let seen = self.flight.seen();
        let max_rate = race.vehicle.max_rates_rad_s();
        // Body rates are not kept beside the filtered commands that make them.
        let [x, y, z] = std::array::from_fn(|k| seen.rates[k] / max_rate[k]);
        let command = [x, y, z, self.flight.throttle()];
        let state = State::new(seen.position, seen.velocity, seen.attitude, command, seen.voltage);
        block.craft.state.set_lane(lane, &state.map(|x| x as f32));
        block.gate.set_lane(lane, &race.gates[self.target]);
        let in_gate = self.gate(race).locate(seen.position);
        block.in_gate.iter_mut().zip(in_gate).for_each(|(x, p)| x.set(lane, p as f32));
        let history = block.history.iter_mut().flatten().zip(self.history.as_flattened());
        history.for_each(|(x, &action)| x.set(lane, action));
    }

    /// Holds `action` for a step, and judges the move by racer's own rules.
    fn step(&mut self, race: &Race, action: [f32; ACTIONS]) {
        let gate = self.gate(race);
        let before = gate.locate(self.flight.seen().position);
        self.flight.hold(action.map(f64::from));
        self.history = [action, self.history[0], self.history[1]];
        let Seen { position, velocity, .. } = self.flight.seen();
        let crossing = crossing(before, gate.locate(position), gate.radius);
        let since = self.steps as f64 + 1.0 - self.passes.last().copied().unwrap_or(0.0);
        let failure = if !position.iter().all(|&x| x.is_finite()) {
            Some("non_finite")
        } else if crossing.missed {
            Some("missed_gate")
        } else if self.flight.rests() {
            Some("ground")
        } else if (0..3).any(|k| !(race.volume[0][k]..=race.volume[1][k]).contains(&position[k])) {
            Some("left_volume")
        } else if !crossing.passed && since * CONTROL_S >= race.config.gate_timeout_s {
            Some("gate_timeout")
        } else if self.steps as f64 * CONTROL_S >= LONGEST_S {
            Some("out_of_time")
        } else {
            None
        };
        if failure.is_none() && crossing.passed {
            self.passes.push(self.steps as f64 + crossing.fraction);
            self.target = (self.target + 1) % race.gates.len();
        }
        self.steps += 1;
        let ([x, y, z], [vx, vy, vz]) = (position, velocity);
        self.path.push([x, y, z, vx, vy, vz]);
        let lap_s = self.passes.get(race.gates.len()).map(|end| (end - self.passes[0]) * CONTROL_S);
        if failure.is_some() || lap_s.is_some() {
            self.ended = Some(Raced { lap_s, failure, path: std::mem::take(&mut self.path) });
        }
    }
}
