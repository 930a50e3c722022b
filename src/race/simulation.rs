//! Races side by side that the caller steps: commands in, observations and transitions out.

use crate::base::check::BadInput;
use crate::base::lane::{Kernel, LANES, Lane, Lane32, Level, Portable, build, dispatch};
use crate::base::rng::RngStream;
use crate::learn::policy::ACTIONS;
use crate::learn::ppo::Environment;
use crate::model::attitude::body_axes;
use crate::model::dynamics::Factors;
use crate::race::config::Setup;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::env::reset::{self, StartPlace};
use crate::race::env::tally::RaceTally;
use crate::race::env::terminate::CAUSES;
use crate::race::env::{Block, Race, lanes};
use rayon::prelude::*;

/// Most vehicles of a simulation.
const MOST: usize = 1 << 24;

/// How a block rests in memory between steps.
type StoredBlock = Block<Portable<f32>>;

/// Many vehicles that race on one track, each for itself: the environment that policies are trained in, to be stepped
/// by hand.
///
/// The first vehicle is nominal, the others have every parameter drawn as the set-up says, and so are noise and delays.
/// All follow from the set-up's seed, whatever the number of threads; work runs on the current rayon pool.
#[derive(Clone, Debug)]
pub struct Simulation {
    level: Level,
    race: Race,
    place: StartPlace,
    vehicles: usize,
    blocks: Vec<StoredBlock>,
}

/// Where a vehicle is and how it moves. World frame ENU, body frame front-left-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// World, m.
    pub position_m: [f64; 3],
    /// World, m/s.
    pub velocity_m_s: [f64; 3],
    /// Body to world, as w, x, y, z.
    pub attitude: [f64; 4],
    /// About body x, y, z, rad/s.
    pub body_rates_rad_s: [f64; 3],
    /// Battery voltage, V.
    pub voltage_v: f64,
    /// The gate that comes next, by its place in the track's list.
    pub target_gate: usize,
    /// Gates passed since the flight began.
    pub gates_passed: usize,
}

impl Motion {
    /// A vector of the world along the vehicle's forward, left and up axes.
    pub fn into_body(&self, world: [f64; 3]) -> [f64; 3] {
        body_axes(self.attitude).map(|axis| (0..3).map(|k| axis[k] * world[k]).sum())
    }
}

/// What a step did to a vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transition {
    /// What training pays for the step.
    pub reward: f32,
    /// Whether the vehicle passed its gate.
    pub passed_gate: bool,
    /// Why the flight ended with this step, if it did. The vehicle's next flight has then begun.
    pub ending: Option<Ending>,
}

/// Why a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The vehicle failed, for example by `collision`: nothing is to be gained any more.
    Failed(&'static str),
    /// The longest time of an episode was over; the vehicle still flew.
    CutOff,
}

impl Simulation {
    /// So many vehicles at `place`, with the set-up's track, vehicle, rules and seed. Fails for none, or more than
    /// 2^24.
    pub fn new(setup: &Setup, vehicles: usize, place: StartPlace) -> Result<Self, BadInput> {
        if !(1..=MOST).contains(&vehicles) {
            return Err(BadInput::new("a simulation", format!("{vehicles} vehicles"), &format!("1 to {MOST}"), ""));
        }
        let Setup { config, track, vehicle } = setup;
        let race = Race::new(&config.env, track, vehicle, config.seed);
        let blocks = (0..vehicles.div_ceil(LANES)).into_par_iter().map(|i| {
            let mut block: StoredBlock = race.empty_block((i * LANES) as u32);
            (0..LANES).for_each(|lane| begin(&race, place, &mut block, lane));
            block
        });
        Ok(Self { level: Level::best(), place, vehicles, blocks: blocks.collect(), race })
    }

    /// Number of vehicles.
    #[allow(clippy::len_without_is_empty, reason = "there is always one")]
    pub fn len(&self) -> usize {
        self.vehicles
    }

    /// Where every vehicle is.
    pub fn motions(&self) -> Vec<Motion> {
        let motion = |i: usize| {
            let (block, lane) = (&self.blocks[i / LANES], i % LANES);
            let craft = block.craft.map(|x| x.get(lane));
            let state = &craft.state;
            Motion {
                position_m: state.position.map(f64::from),
                velocity_m_s: state.velocity.map(f64::from),
                attitude: state.attitude.map(f64::from),
                body_rates_rad_s: craft.body_rates().map(f64::from),
                voltage_v: f64::from(craft.terminal_voltage()),
                target_gate: block.target[lane] as usize,
                gates_passed: block.passed[lane] as usize,
            }
        };
        (0..self.vehicles).into_par_iter().map(motion).collect()
    }

    /// What a policy would see of every vehicle, noise included; the same until the next step.
    pub fn observations(&self) -> Vec<[f32; OBSERVATIONS]> {
        let of = |block: &StoredBlock| dispatch(self.level, Observe { race: &self.race, block });
        let mut all: Vec<_> = self.blocks.par_iter().flat_map_iter(of).collect();
        all.truncate(self.vehicles);
        all
    }

    /// One step of 10 ms: `commands[i]` is what vehicle `i` is told, roll, pitch and yaw rate and thrust, each limited
    /// to [-1, 1]. Fails unless there is one for each vehicle and all are numbers.
    pub fn step(&mut self, commands: &[[f32; ACTIONS]]) -> Result<Vec<Transition>, BadInput> {
        let vehicles = self.vehicles;
        if commands.len() != vehicles {
            let expected = format!("{vehicles}, one for each vehicle");
            return Err(BadInput::new("commands", commands.len(), &expected, ""));
        }
        if let Some(i) = commands.iter().position(|command| command.iter().any(|x| !x.is_finite())) {
            return Err(BadInput::new(format!("commands[{i}]"), format!("{:?}", commands[i]), "finite numbers", ""));
        }
        let (level, race, place) = (self.level, &self.race, self.place);
        let mut out = vec![Transition::default(); vehicles];
        let parts = self.blocks.par_iter_mut().zip(commands.par_chunks(LANES)).zip(out.par_chunks_mut(LANES));
        parts.for_each(|((block, commands), out)| dispatch(level, StepJob { race, place, block, commands, out }));
        Ok(out)
    }
}

/// Begins a flight in `lane`.
fn begin<L: Lane32>(race: &Race, place: StartPlace, block: &mut Block<L>, lane: usize) {
    let vehicle = block.first + lane as u32;
    let mut rng = race.rng.sequence(RngStream::Reset, vehicle, block.step);
    let start = reset::draw(race, &mut rng, place, (vehicle == 0).then_some(Factors::NOMINAL));
    block.begin(race, lane, &start);
}

struct Observe<'a> {
    race: &'a Race,
    block: &'a StoredBlock,
}

impl Kernel for Observe<'_> {
    type Output = [[f32; OBSERVATIONS]; LANES];

    #[inline(always)]
    fn run<L: Lane32>(self) -> Self::Output {
        let block: Block<L> = self.race.load(self.block);
        let mut seen = [0.0; OBSERVATIONS * LANES];
        block.observe(self.race, &mut seen, LANES);
        build!(|lane| build!(|k| seen[k * LANES + lane]))
    }
}

struct StepJob<'a> {
    race: &'a Race,
    place: StartPlace,
    block: &'a mut StoredBlock,
    commands: &'a [[f32; ACTIONS]],
    out: &'a mut [Transition],
}

impl Kernel for StepJob<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lane32>(self) {
        let StepJob { race, place, block: rest, commands, out } = self;
        let mut block: Block<L> = race.load(rest);
        let told = |lane: usize, k: usize| commands.get(lane).map_or(0.0, |command| command[k].clamp(-1.0, 1.0));
        let mut action = [[0.0; LANES]; ACTIONS];
        for (k, row) in action.iter_mut().enumerate() {
            row.iter_mut().enumerate().for_each(|(lane, x)| *x = told(lane, k));
        }
        let outcome = block.step(race, build!(|k| L::from_array(action[k])));
        for (lane, transition) in out.iter_mut().enumerate() {
            let is = |bits: u32| bits >> lane & 1 == 1;
            let failed = (0..CAUSES.len()).find(|&cause| is(outcome.causes[cause]));
            *transition = Transition {
                reward: outcome.reward.get(lane),
                passed_gate: is(outcome.passed),
                ending: failed
                    .map(|cause| Ending::Failed(CAUSES[cause]))
                    .or(is(outcome.truncated).then_some(Ending::CutOff)),
            };
        }
        for lane in lanes(outcome.terminated | outcome.truncated) {
            begin(race, place, &mut block, lane);
        }
        *rest = race.save(&block, &mut RaceTally::default());
    }
}
