//! The thrust from whatever is nearest to the rotors: their speeds, the motors' outputs, or else the command; and from
//! there the curve that a policy needs, over the collective command.

use super::force::{Force, flown_volts};
use super::force_terms::{DRAG_AT, ForceTerms, OFFSET, SQUARE, TAU, THRUST};
use super::inputs::Inputs;
use super::law::Law;
use super::mixer::{self, Mixer};
use super::nearest::FlownRange;
use super::solve::Solution;
use crate::insight::prepare::data::{Data, DataPart};
use crate::insight::prepare::rotors::command_per_speed;
use crate::model::vehicle::identified::{RotorChain, ThrustSource};

/// What was found of the thrust.
pub struct ThrustFit {
    pub source: ThrustSource,
    /// Time constant (s) and curve (m/s2) over the command, drag (1/m) and offsets, as [`Force::fit`] orders them.
    pub solution: Solution,
    /// Curve and lag over the motors' outputs, where they were logged.
    pub motors: Option<Solution>,
    /// From command to rotors; none where the command is all there is.
    pub chain: Option<RotorChain>,
    /// What the collective command says of the mean motor output.
    pub mixer: Option<Mixer>,
    /// 1 and 99 % of the command in flight, -1..1.
    pub flown: [f64; 2],
    /// Whether the logs have a lag from command to thrust.
    pub lags: bool,
}

/// The thrust that the rotors' speeds make.
struct BySpeed {
    /// Of every flight at every sample, m/s2.
    thrust: Vec<Vec<f64>>,
    /// The curve of one number over the speeds, with the drag.
    solution: Solution,
    /// Thrust over mass over the mean square of the speeds, m/rad2.
    per_square: f64,
    /// 1 and 99 % of the mean speed, as a command.
    flown: [f64; 2],
}

impl BySpeed {
    /// `None` where a flight has no speeds. `scale` (s/rad) makes a command of a speed.
    fn fit(data: &Data, part: DataPart, terms: &ForceTerms, scale: f64) -> Option<Self> {
        let speeds = Inputs::speeds(data, scale)?;
        let force = Force::new(data, &speeds, ForceTerms { curves: vec![SQUARE], ..terms.clone() }, None);
        let solution = force.fit(part)?;
        let per_square = solution.values[THRUST] / SQUARE[0] * scale * scale;
        Some(Self { thrust: force.thrust_by(&solution), per_square, flown: force.flown(0.0), solution })
    }

    /// Where the command is the rotors' speed it has neither lag nor mixer, and the curve over it is the square's.
    fn alone(self, command_per_speed: f64) -> ThrustFit {
        let chain = RotorChain {
            command_per_speed: Some(command_per_speed),
            thrust_n_per_speed_squared: Some(self.per_square),
            ..RotorChain::DIRECT
        };
        ThrustFit {
            source: ThrustSource::Speeds,
            solution: self.solution,
            motors: None,
            chain: Some(chain),
            mixer: None,
            flown: self.flown,
            lags: false,
        }
    }
}

/// Fits what the logs have of the chain.
pub fn fit(data: &Data, part: DataPart, terms: &ForceTerms) -> Option<ThrustFit> {
    let scale = data.flights.first().and_then(|f| command_per_speed(&f.quality.log));
    let by_speed = BySpeed::fit(data, part, terms, scale.unwrap_or(1.0 / fastest_rotor(data)));
    if let Some(scale) = scale {
        return by_speed.map(|by_speed| by_speed.alone(scale));
    }
    let (motors, command) = (Inputs::motors(data), Inputs::command(data));
    let inputs = motors.as_ref().unwrap_or(&command);
    let without_drag = ForceTerms { drag: false, given_drag: [0.0; 3], ..terms.clone() };
    // What the rotors do is known where they were measured; the curve over what they were sent is fitted to that.
    let force = match &by_speed {
        Some(by_speed) => Force::new(data, inputs, without_drag.clone(), Some(&by_speed.thrust)),
        None => Force::new(data, inputs, terms.clone(), None),
    };
    let mut law = Law::fit(force, part, motors.is_some())?;
    if let Some(by_speed) = &by_speed {
        with_drag_of(&mut law.fitted, &by_speed.solution);
    }
    let source = match (&by_speed, &motors) {
        (Some(_), _) => ThrustSource::Speeds,
        (None, Some(_)) => ThrustSource::Motors,
        (None, None) => ThrustSource::Command,
    };
    let lag = law.fitted.values[TAU];
    let flown = |inputs: &Inputs| FlownRange {
        commands: Force::new(data, inputs, without_drag.clone(), None).flown(lag),
        volts: flown_volts(data, terms.volts),
    };
    let over_inputs = match law.terms.power_at_v {
        Some(_) => law.over(&|u, _| u, terms, flown(inputs))?,
        None => law.fitted.clone(),
    };
    let flown = flown(&command);
    let chain = RotorChain {
        thrust_n_per_speed_squared: by_speed.as_ref().map(|by_speed| by_speed.per_square),
        ..RotorChain::DIRECT
    };
    let over_command = ThrustFit {
        source,
        solution: over_inputs,
        motors: None,
        chain: by_speed.is_some().then_some(chain),
        mixer: None,
        flown: flown.commands,
        lags: true,
    };
    if motors.is_none() { Some(over_command) } else { behind_mixer(data, part, terms, &law, flown, over_command) }
}

/// The fit over the motors' outputs, `over_motors`, as one over the command.
fn behind_mixer(
    data: &Data,
    part: DataPart,
    terms: &ForceTerms,
    law: &Law,
    flown: FlownRange,
    over_motors: ThrustFit,
) -> Option<ThrustFit> {
    let motors = over_motors.solution;
    let mut solution = motors.clone();
    let mut chain = over_motors.chain.unwrap_or(RotorChain::DIRECT);
    let mixer = mixer::fit(data, part, terms.by_voltage());
    if let Some(mixer) = &mixer {
        chain = RotorChain { thrust_n_per_speed_squared: chain.thrust_n_per_speed_squared, ..mixer.chain };
        let motor = |u: f64, v: f64| 2.0 * chain.motor(0.5 + 0.5 * u, v).clamp(0.0, 1.0) - 1.0;
        solution = law.over(&motor, terms, flown)?;
        solution.values[TAU] += chain.command_lag_s.unwrap_or(0.0);
        let lag = if mixer.solution.at_bound[0] { 0.0 } else { mixer.solution.covariance[(0, 0)] };
        solution.covariance[(TAU, TAU)] += lag;
    }
    chain.rotor_lag_s = Some(motors.values[TAU]);
    Some(ThrustFit { solution, motors: Some(motors), chain: Some(chain), mixer, ..over_motors })
}

/// The fastest that any rotor turned, rad/s: what makes 1 where the log does not say which speed is full.
fn fastest_rotor(data: &Data) -> f64 {
    let speeds = data.flights.iter().flat_map(|f| f.quality.log.rotors.rows.iter().flatten());
    speeds.copied().filter(|w| w.is_finite()).fold(1.0, f64::max)
}

fn with_drag_of(to: &mut Solution, from: &Solution) {
    let taken = DRAG_AT..OFFSET + 2;
    for i in taken.clone() {
        to.values[i] = from.values[i];
        to.at_bound[i] = from.at_bound[i];
        taken.clone().for_each(|j| to.covariance[(i, j)] = from.covariance[(i, j)]);
    }
    to.noise.clone_from(&from.noise);
}
