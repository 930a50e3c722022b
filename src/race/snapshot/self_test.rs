//! Consecutive steps of a flight, kept with a policy: whoever flies it elsewhere can tell whether states become
//! observations, actions and setpoints as they did here.

use crate::base::check::Invalid;
use crate::learn::nn::Network;
use crate::learn::policy::ACTIONS;
use crate::model::constants::CONTROL_S;
use crate::model::dynamics::{Craft, Factors, State};
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::act::act;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::onboard::{AT_START, Crossing, Decision, Estimate, Memory, Onboard, Surroundings};

/// Steps kept where that is enough for two switches of the target gate, and at most.
pub const LEAST: usize = 64;
const MOST: usize = 256;
/// Steps kept before and after two switches that lie far apart.
const AROUND: usize = 8;
/// Largest difference of an observation's entry, or of an action, between one processor and another.
pub const TOLERANCE: f64 = 1e-4;
/// Columns of a state: position, velocity, attitude, body rates, voltage.
pub const STATE: usize = 14;
/// Columns of a setpoint: body rates, throttle, thrust, thrust over the weight; and how far each may be off.
pub const SETPOINT: usize = 6;
pub const SETPOINT_TOLERANCE: [f64; SETPOINT] = [2e-3, 2e-3, 2e-3, 1e-4, 5e-3, 5e-4];

/// A step of a flight: what was known, and what was answered.
#[derive(Clone, Copy, Debug)]
pub struct FlownStep {
    pub estimate: Estimate,
    pub answer: Decision,
}

/// The nominal vehicle's flight from the pad with a full battery, undisturbed.
#[derive(Clone, Debug)]
pub struct NominalFlight {
    pub steps: Vec<FlownStep>,
    /// From the first crossing of the first gate to its next, s, where it came so far.
    pub lap_s: Option<f64>,
}

/// Flies until a lap is complete, a gate is missed, the volume is left, or `most` steps are over.
pub fn fly(network: &Network<f32>, track: &Track, vehicle: &Vehicle, most: usize) -> NominalFlight {
    let around = Surroundings::of(track, vehicle);
    let mut onboard = Onboard { network, around: &around, memory: Memory::before(0, AT_START) };
    let (sin, cos) = (0.5 * track.start.heading_rad()).sin_cos();
    let state = State::new(
        track.start.position_m,
        [0.0; 3],
        [cos, 0.0, 0.0, sin],
        AT_START.map(f64::from),
        vehicle.battery.full_v,
    );
    let mut craft = Craft::new(vehicle, &Factors::NOMINAL, CONTROL_S, state).map(|x| x as f32);
    let (mut steps, mut passes) = (Vec::new(), Vec::new());
    for step in 0..most {
        let State { position, velocity, attitude, .. } = craft.state;
        let (body_rates, voltage) = (craft.body_rates(), craft.terminal_voltage());
        let estimate = Estimate { position, velocity, attitude, body_rates, voltage };
        let answer = onboard.step(&estimate);
        if answer.crossing == Crossing::Passed {
            passes.push((step as f64 - 1.0 + f64::from(answer.fraction)) * CONTROL_S);
        }
        let lost = !track.volume.contains(&position.map(f64::from).into()) || answer.crossing == Crossing::Missed;
        if lost || passes.len() > track.gates.len() {
            break;
        }
        steps.push(FlownStep { estimate, answer });
        craft.step(answer.action);
    }
    NominalFlight { steps, lap_s: passes.get(track.gates.len()).map(|end| end - passes[0]) }
}

/// Steps at which the target gate was switched.
pub fn switches(steps: &[FlownStep]) -> Vec<usize> {
    (0..steps.len()).filter(|&i| steps[i].answer.crossing == Crossing::Passed).collect()
}

/// The part of a flight that is kept: around the two switches that follow each other fastest, or from its beginning
/// where there are no two.
pub fn window(steps: &[FlownStep]) -> &[FlownStep] {
    let all = switches(steps);
    let pairs = all.windows(2).map(|pair| (pair[0], pair[1]));
    let closest = pairs.min_by_key(|(first, second)| second - first);
    let (first, second) = closest.or(all.first().map(|&i| (i, i))).unwrap_or((0, 0));
    let length = (second - first + 1 + 2 * AROUND).clamp(LEAST, MOST).min(steps.len());
    let begin = ((first + second + 1).saturating_sub(length) / 2).min(steps.len() - length);
    &steps[begin..begin + length]
}

/// The numbers of a state, in the order of the columns.
pub fn state_row(e: &Estimate) -> [f32; STATE] {
    let mut row = [0.0; STATE];
    let parts: [&[f32]; 5] = [&e.position, &e.velocity, &e.attitude, &e.body_rates, &[e.voltage]];
    row.iter_mut().zip(parts.concat()).for_each(|(x, value)| *x = value);
    row
}

/// The state of a row.
pub fn estimate(row: &[f32; STATE]) -> Estimate {
    let three = |at: usize| [row[at], row[at + 1], row[at + 2]];
    let attitude = [row[6], row[7], row[8], row[9]];
    Estimate { position: three(0), velocity: three(3), attitude, body_rates: three(10), voltage: row[13] }
}

/// The numbers of a setpoint, in the order of the columns.
pub fn setpoint_row(answer: &Decision) -> [f32; SETPOINT] {
    let s = &answer.setpoint;
    let [x, y, z] = s.body_rates;
    [x, y, z, s.throttle, s.thrust_n, s.thrust_to_weight]
}

/// What a file holds of the window, one row a step.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfTestRows {
    pub state: Vec<[f32; STATE]>,
    pub target: Vec<i32>,
    pub observation: Vec<[f32; OBSERVATIONS]>,
    pub action: Vec<[f32; ACTIONS]>,
    pub setpoint: Vec<[f32; SETPOINT]>,
}

impl SelfTestRows {
    /// Of these steps.
    pub fn of(steps: &[FlownStep]) -> Self {
        Self {
            state: steps.iter().map(|s| state_row(&s.estimate)).collect(),
            target: steps.iter().map(|s| s.answer.target as i32).collect(),
            observation: steps.iter().map(|s| s.answer.observation).collect(),
            action: steps.iter().map(|s| s.answer.action).collect(),
            setpoint: steps.iter().map(|s| setpoint_row(&s.answer)).collect(),
        }
    }

    /// What is remembered before the first step: it is in the first observation.
    fn memory(&self, gates: usize) -> Option<Memory> {
        let (seen, target) = (self.observation.first()?, usize::try_from(*self.target.first()?).ok()?);
        let four = |at: usize| std::array::from_fn(|k| seen[at + k]);
        let history = [four(COMMAND + 4), four(COMMAND + 8), four(COMMAND + 12)];
        (target < gates).then_some(Memory { command: four(COMMAND), history, target, position: None })
    }

    /// Whether the states lead to these observations, actions and setpoints.
    pub fn check(&self, network: &Network<f32>, around: &Surroundings) -> Result<(), Invalid> {
        check_network(network, &self.observation, &self.action)?;
        let mut worst = [0.0f32; 3];
        let memory = self.memory(around.gates.len());
        let mut onboard = memory.map(|memory| Onboard { network, around, memory });
        for (i, row) in self.state.iter().enumerate() {
            let Some(onboard) = onboard.as_mut() else { break };
            let answer = onboard.step(&estimate(row));
            let off = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            worst[0] = worst[0].max(off(&answer.observation, &self.observation[i]));
            worst[1] = worst[1].max((answer.target as i32 - self.target[i]).abs() as f32);
            let setpoint = setpoint_row(&answer);
            let share = |k: usize| (setpoint[k] - self.setpoint[i][k]).abs() / SETPOINT_TOLERANCE[k] as f32;
            worst[2] = (0..SETPOINT).map(share).fold(worst[2], f32::max);
        }
        let advice = "fly it with the racer that trained it";
        for (key, worst, limit) in [
            ("self_test.observation", worst[0], TOLERANCE as f32),
            ("self_test.target", worst[1], 0.0),
            ("self_test.setpoint", worst[2], 1.0),
        ] {
            let found = format!("differs from what this version makes of the states (by {worst}, {limit} is allowed)");
            Invalid::unless(worst <= limit, key, found, "", advice)?;
        }
        Ok(())
    }
}

/// Where the filtered command begins in an observation; the three actions follow it.
const COMMAND: usize = crate::race::env::observe::first_entry("command");

/// Whether `network` answers `observations` with `expected`.
pub fn check_network(
    network: &Network<f32>,
    observations: &[[f32; OBSERVATIONS]],
    expected: &[[f32; ACTIONS]],
) -> Result<(), Invalid> {
    let found = act(network, observations);
    let pairs = found.as_flattened().iter().zip(expected.as_flattened());
    let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let complaint = format!("actions that differ by {worst} from those the policy gave when it was written");
    Invalid::unless(
        f64::from(worst) <= TOLERANCE,
        "self_test.action",
        complaint,
        "",
        "the file is damaged; use another copy",
    )
}
