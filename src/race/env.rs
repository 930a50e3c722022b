//! The race: what a policy sees, what it is paid, when a flight starts and ends.

pub mod gates;
mod learn;
pub mod noise;
pub mod observe;
pub mod reset;
pub mod reward;
pub mod tally;
pub mod terminate;

use crate::base::check::{Check, Invalid};
use crate::base::lane::{Bits, LANES, Lane, Lane32, Mask, build, each, sum_of_squares};
use crate::base::rng::Philox;
use crate::model::attitude::{body_axes, dot};
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::{Craft, Factors, State};
use crate::model::track::{Pose, Track};
use crate::model::vehicle::Vehicle;
use crate::model::vehicle::randomize::RandomizeConfig;
use gates::GateFrame;
use nalgebra::Vector3;
use noise::NoiseConfig;
use reset::{ResetConfig, Start};
use reward::{RewardConfig, TERMS};
use serde::{Deserialize, Serialize};
use terminate::CAUSES;

/// The race as it is trained. Volume and altitude limits are the track's, voltage limits the vehicle's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvConfig {
    /// Steps of 10 ms after which an episode is truncated; it bootstraps from where it was.
    pub horizon_steps: u32,
    /// Longest time without passing a gate, s. Shorter forbids hovering sooner, too short forbids hard gates.
    pub gate_timeout_s: f64,
    /// Aperture radius of physical gates while training, m. Smaller than the track's, so that passing leaves a margin.
    pub gate_radius_m: f64,
    /// Factor of all apertures when training begins, from where it falls to 1 linearly. Above 1, the way is learnt
    /// first and how to hit a gate afterwards; at 1, a seed may never find through one of them.
    pub gate_radius_begin: f64,
    /// Million steps of training after which apertures are as they are; at the latest after half of the budget.
    pub gate_radius_full: f64,
    pub noise: NoiseConfig,
    pub reset: ResetConfig,
    pub randomize: RandomizeConfig,
    pub reward: RewardConfig,
}

impl EnvConfig {
    /// Factor of all apertures after so many steps of training, `share` of its budget.
    pub fn widened(&self, steps: u64, share: f64) -> f64 {
        let (begin, full) = (self.gate_radius_begin, 1e6 * self.gate_radius_full);
        let done = if full > 0.0 { (steps as f64 / full).max(2.0 * share).min(1.0) } else { 1.0 };
        begin + (1.0 - begin) * done
    }
}

impl Check for EnvConfig {
    fn check(&self) -> Result<(), Invalid> {
        let steps = self.horizon_steps;
        Invalid::unless((1..=1_000_000).contains(&steps), "horizon_steps", steps, "1 to 1000000", "")?;
        Invalid::unless_positive("gate_timeout_s", self.gate_timeout_s, "")?;
        Invalid::unless_positive("gate_radius_m", self.gate_radius_m, "a gate of no width cannot be passed")?;
        let begin = self.gate_radius_begin;
        Invalid::unless((1.0..=10.0).contains(&begin), "gate_radius_begin", begin, "1 to 10", "1 is no widening")?;
        Invalid::unless_not_negative("gate_radius_full", self.gate_radius_full, "")?;
        self.noise.check().map_err(|invalid| invalid.within("noise"))?;
        self.reset.check().map_err(|invalid| invalid.within("reset"))?;
        self.randomize.check().map_err(|invalid| invalid.within("randomize"))?;
        self.reward.check().map_err(|invalid| invalid.within("reward"))
    }
}

/// A track, a vehicle and the rules: everything that a race's episodes share.
#[derive(Clone, Debug)]
pub struct Race {
    pub config: EnvConfig,
    pub vehicle: Vehicle,
    pub start: Pose,
    /// Frames of the gates, cyclic.
    pub gates: Vec<GateFrame<f32>>,
    /// Points along the lap, equally far apart, with the gate that comes next.
    pub lap: Vec<LapPoint>,
    /// For each gate, indices of the points after which it or the one before it comes next: a reset looks here.
    pub approaches: Vec<Vec<usize>>,
    /// Lower and upper corner of the flight volume, m.
    pub volume: [[f64; 3]; 2],
    /// Offset and scale of the observed voltage: those of the vehicle that the policy was trained with.
    pub voltage_scale: [f64; 2],
    /// Voltage below which the flight ends, V.
    pub empty_v: f64,
    /// Thrust command that carries the nominal vehicle on a half-empty battery.
    pub hover_command: f64,
    pub dt: f64,
    pub rng: Philox,
    /// Whether observations and actions are disturbed.
    pub noisy: bool,
}

/// A point of the lap's spline.
#[derive(Clone, Debug)]
pub struct LapPoint {
    pub position: Vector3<f64>,
    pub tangent: Vector3<f64>,
    /// Index of the gate that comes next.
    pub target: usize,
}

/// 16 episodes side by side. `Block<Portable<f32>>` is how they rest in memory between rollouts.
#[derive(Clone, Debug)]
pub struct Block<R> {
    pub craft: Craft<R>,
    /// The target gate of each lane.
    pub gate: GateFrame<R>,
    /// The last three actions as the policy gave them, newest first.
    pub history: [[R; 4]; 3],
    /// Position in the target gate's frame, m.
    pub in_gate: [R; 3],
    /// Steps since the episode began, and since its last gate.
    pub clock: R,
    pub gate_clock: R,
    /// Reward gathered in the episode.
    pub gathered: R,
    /// Sums of the reward's terms since they were last cleared.
    pub terms: [R; TERMS.len()],
    /// Index of the target gate, and gates passed in the episode.
    pub target: [u32; LANES],
    pub passed: [u32; LANES],
    /// The number of the block's first environment.
    pub first: u32,
    /// Steps this block has made; part of the noise's counter.
    pub step: u32,
}

/// What a step did, before ended episodes are begun anew.
#[derive(Clone, Copy, Debug)]
pub struct Outcome<L: Lane> {
    /// The reward by term, which tests add up.
    #[cfg_attr(not(feature = "internals"), allow(dead_code))]
    pub terms: [L; TERMS.len()],
    pub reward: L,
    /// Lanes that passed their gate, as bits, and when within the step they did, 0..1.
    pub passed: u32,
    pub fraction: L,
    /// Lanes that ended, by cause.
    pub causes: [u32; CAUSES.len()],
    /// Lanes that ended for good, and lanes that ran into the horizon alive.
    pub terminated: u32,
    pub truncated: u32,
}

impl Race {
    /// A race on `track` with `vehicle`; `seed` decides every random number. Physical gates have the training aperture
    /// of the configuration.
    pub fn new(config: &EnvConfig, track: &Track, vehicle: &Vehicle, seed: u64) -> Self {
        let gates = gates::frames(track, Some(config.gate_radius_m));
        let lap: Vec<LapPoint> = track
            .reset_spline()
            .samples(LAP_POINTS)
            .into_iter()
            .map(|s| LapPoint { position: s.position, tangent: s.tangent, target: track.gate_after(s.next) })
            .collect();
        let n = gates.len();
        let approach = |gate: usize| {
            let leads = |i: &usize| [(gate + n - 1) % n, gate].contains(&lap[*i].target);
            (0..lap.len()).filter(leads).collect()
        };
        Race {
            config: config.clone(),
            approaches: (0..n).map(approach).collect(),
            start: track.start,
            gates,
            lap,
            volume: [track.volume.min_m, track.volume.max_m],
            voltage_scale: observe::voltage_scale(&vehicle.battery),
            empty_v: vehicle.battery.empty_v,
            hover_command: vehicle.hover_command(0.5 * (vehicle.battery.full_v + vehicle.battery.empty_v)),
            vehicle: vehicle.clone(),
            dt: CONTROL_S,
            rng: Philox::new(seed),
            noisy: true,
        }
    }

    /// The race as a policy sees it that was trained with `vehicle`, whatever flies.
    pub fn seen_as(self, vehicle: &Vehicle) -> Self {
        Race { voltage_scale: observe::voltage_scale(&vehicle.battery), ..self }
    }

    /// The race as a lap is scored: full apertures, nothing disturbed.
    pub fn scored(&self, track: &Track) -> Self {
        Race { gates: gates::frames(track, None), noisy: false, ..self.clone() }
    }

    /// A block whose 16 episodes have not begun; give every lane a start with [`Block::begin`].
    pub fn empty_block<L: Lane32>(&self, first: u32) -> Block<L> {
        let state = State::new([0.0; 3], [0.0; 3], [1.0, 0.0, 0.0, 0.0], [0.0; 4], self.vehicle.battery.full_v);
        Block {
            craft: Craft::new(&self.vehicle, &Factors::NOMINAL, self.dt, state).map(L::of),
            gate: self.gates[0].map(L::splat),
            history: [[L::zero(); 4]; 3],
            in_gate: [L::zero(); 3],
            clock: L::zero(),
            gate_clock: L::zero(),
            gathered: L::zero(),
            terms: [L::zero(); TERMS.len()],
            target: [0; LANES],
            passed: [0; LANES],
            first,
            step: 0,
        }
    }
}

/// Points kept of the lap's spline.
const LAP_POINTS: usize = 2048;

impl<R: Copy> Block<R> {
    /// Converts every number.
    #[inline(always)]
    pub fn map<S>(&self, mut f: impl FnMut(R) -> S) -> Block<S> {
        Block {
            craft: self.craft.map(&mut f),
            gate: self.gate.map(&mut f),
            history: self.history.map(|a| a.map(&mut f)),
            in_gate: self.in_gate.map(&mut f),
            clock: f(self.clock),
            gate_clock: f(self.gate_clock),
            gathered: f(self.gathered),
            terms: self.terms.map(&mut f),
            target: self.target,
            passed: self.passed,
            first: self.first,
            step: self.step,
        }
    }
}

impl<L: Lane32> Block<L> {
    /// The block's environments, part of the noise's counter.
    #[inline(always)]
    fn environments(&self) -> L::Bits {
        L::Bits::from_array(build!(|i| self.first + i as u32))
    }

    /// Writes the observation of the 16 lanes, entry `k` to `out[k * stride..]`. A function of its own, as
    /// [`Block::step`]: rollouts, evaluations and races share one compiled body for each kind of block.
    pub fn observe(&self, race: &Race, out: &mut [f32], stride: usize) {
        L::vectorize(
            #[inline(always)]
            || {
                // No `then`: a closure is compiled on its own, without the block's instructions.
                let noise = if race.noisy {
                    Some(noise::of_observation(&race.config.noise, &race.rng, self.environments(), self.step))
                } else {
                    None
                };
                observe::observe(&self.seen(), noise.as_ref(), race.voltage_scale, out, stride);
            },
        )
    }

    /// What its observations are made of.
    #[inline(always)]
    fn seen(&self) -> observe::ObservationInputs<'_, L> {
        observe::ObservationInputs {
            gate: &self.gate,
            in_gate: self.in_gate,
            velocity: self.craft.state.velocity,
            attitude: self.craft.state.attitude,
            body_rates: self.craft.body_rates(),
            command: &self.craft.state.command,
            history: &self.history,
            voltage: self.craft.terminal_voltage(),
        }
    }

    /// One step under `action`, as the policy gave it. Ended episodes stay as they ended.
    pub fn step(&mut self, race: &Race, action: [L; 4]) -> Outcome<L> {
        L::vectorize(
            #[inline(always)]
            || self.stepped(race, action),
        )
    }

    #[inline(always)]
    fn stepped(&mut self, race: &Race, action: [L; 4]) -> Outcome<L> {
        let config = &race.config;
        let applied = if race.noisy {
            let noise = noise::of_action::<L>(&config.noise, &race.rng, self.environments(), self.step);
            build!(|i| (action[i] + noise[i]).clamp(-L::one(), L::one()))
        } else {
            action
        };
        let before = self.in_gate;
        self.craft.step(applied);
        let state = &self.craft.state;
        let after = self.gate.locate(state.position);
        let crossing = gates::crossing(before, after, self.gate.radius);
        self.clock = self.clock + L::one();
        self.gate_clock = L::select(crossing.passed, L::zero(), self.gate_clock + L::one());
        let timed_out = L::of(config.gate_timeout_s / race.dt).le(self.gate_clock);

        let distance = each!([before, after], |v| sum_of_squares(v).sqrt());
        let forward = self.gate.rotate(body_axes(state.attitude)[0]);
        let change: [L; 4] = build!(|i| action[i] - self.history[0][i]);
        let terms = reward::terms(
            &config.reward,
            &reward::RewardInputs {
                distance,
                passed: crossing.passed,
                timed_out,
                height: state.position[2],
                facing: -dot(forward, after) / distance[1].max(L::of(1e-3)),
                action_change: sum_of_squares(change),
            },
        )
        .in_order();
        let mut reward = terms[0];
        for &term in &terms[1..] {
            reward = reward + term;
        }
        self.gathered = self.gathered + reward;
        self.terms = build!(|i| self.terms[i] + terms[i]);
        self.history = [action, self.history[0], self.history[1]];
        self.step += 1;

        let causes = terminate::causes(race, self, crossing.missed, timed_out);
        let terminated = causes.iter().fold(0, |all, &lanes| all | lanes);
        let truncated = L::of(config.horizon_steps as f64).le(self.clock).bits() & !terminated;
        self.in_gate = after;
        let passed = crossing.passed.bits() & !terminated;
        for lane in lanes(passed) {
            self.passed[lane] += 1;
            self.aim(race, lane, self.target[lane] as usize + 1);
        }
        Outcome { terms, reward, passed, fraction: crossing.fraction, causes, terminated, truncated }
    }

    /// Begins a new episode in `lane`.
    pub fn begin(&mut self, race: &Race, lane: usize, start: &Start) {
        self.craft.set_lane(lane, &start.craft.map(|x| x as f32));
        for action in &mut self.history {
            action.iter_mut().zip(start.craft.state.command).for_each(|(x, u)| x.set(lane, u as f32));
        }
        for count in [&mut self.clock, &mut self.gate_clock, &mut self.gathered] {
            count.set(lane, 0.0);
        }
        self.passed[lane] = 0;
        self.aim(race, lane, start.target);
    }

    /// Makes gate `index` (modulo the lap) the target of `lane`.
    fn aim(&mut self, race: &Race, lane: usize, index: usize) {
        let index = index % race.gates.len();
        let gate = &race.gates[index];
        self.target[lane] = index as u32;
        self.gate.set_lane(lane, gate);
        let position = gate.locate(self.craft.state.position.map(|x| x.get(lane)));
        self.in_gate.iter_mut().zip(position).for_each(|(x, p)| x.set(lane, p));
    }
}

/// The set bits of a mask of lanes.
pub fn lanes(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (bits != 0).then(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            lane
        })
    })
}
