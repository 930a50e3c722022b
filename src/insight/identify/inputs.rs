//! What the thrust follows: the collective command, the motors one by one, or the rotors.

use crate::base::stats::quantile;
use crate::flight::series::held;
use crate::insight::prepare::data::{Chosen, Data};
use crate::insight::prepare::flight::PreparedFlight;
use crate::insight::prepare::lag::{Following, followed};
use crate::insight::prepare::lately::Lately;
use crate::insight::prepare::rotors::columns;
use std::sync::Arc;

/// One flight's commands to whatever lifts it, each -1 to 1.
struct FlightInputs {
    time_s: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

/// Commands of every flight.
pub struct Inputs {
    flights: Vec<FlightInputs>,
    /// Whether they are what lifts itself, and not commands that it follows behind a lag.
    at_once: bool,
    /// By flight and lag.
    lagged: Lately<(usize, f64), Vec<Vec<f64>>>,
}

/// Lags of every flight that are kept: those of one step of a fit.
const LAGS: usize = 3;

impl Inputs {
    fn new(flights: Vec<FlightInputs>, at_once: bool) -> Self {
        Self { lagged: Lately::new(LAGS * flights.len().max(1)), flights, at_once }
    }

    /// The collective command.
    pub fn command(data: &Data) -> Self {
        let one = |flight: &PreparedFlight| {
            let setpoint = &flight.quality.log.setpoint;
            let column = setpoint.column(3).iter().map(|u| 2.0 * u - 1.0).collect();
            FlightInputs { time_s: setpoint.time_s.clone(), columns: vec![column] }
        };
        Self::new(data.flights.iter().map(one).collect(), false)
    }

    /// The motors' outputs; none where a flight lacks them.
    pub fn motors(data: &Data) -> Option<Self> {
        let one = |flight: &PreparedFlight| {
            let motors = &flight.quality.log.motors;
            let columns = columns(motors)?.iter().map(|m| m.iter().map(|u| 2.0 * u - 1.0).collect()).collect();
            Some(FlightInputs { time_s: motors.time_s.clone(), columns })
        };
        Some(Self::new(data.flights.iter().map(one).collect::<Option<_>>()?, false))
    }

    /// The rotors' speeds, of which `scale` (s/rad) makes 0 to 1; none where a flight lacks them.
    pub fn speeds(data: &Data, scale: f64) -> Option<Self> {
        let one = |flight: &PreparedFlight| {
            let rotors = &flight.quality.log.rotors;
            let columns = columns(rotors)?;
            let columns = columns.iter().map(|w| w.iter().map(|w| 2.0 * w * scale - 1.0).collect());
            Some(FlightInputs { time_s: rotors.time_s.clone(), columns: columns.collect() })
        };
        Some(Self::new(data.flights.iter().map(one).collect::<Option<_>>()?, true))
    }

    /// Whether there is a lag to find.
    pub fn lags(&self) -> bool {
        !self.at_once
    }

    /// Each command of `flight` at the samples of its IMU, `time`, behind a lag of `tau` seconds where there is one.
    pub fn at(&self, flight: usize, time: &[f64], tau: f64) -> Arc<Vec<Vec<f64>>> {
        let FlightInputs { time_s, columns } = &self.flights[flight];
        let one = |column: &Vec<f64>| {
            if self.at_once { held(time_s, column, time) } else { followed(time_s, column, time, Following::lag(tau)) }
        };
        self.lagged.get((flight, tau), || columns.iter().map(one).collect())
    }

    /// 1 and 99 % of the mean command of the chosen samples, -1..1.
    pub fn flown(&self, data: &Data, chosen: &Chosen, tau: f64) -> [f64; 2] {
        let mean = |(f, flight): (usize, &PreparedFlight)| {
            let all = self.at(f, &flight.time, tau);
            (0..flight.time.len()).map(|i| all.iter().map(|x| x[i]).sum::<f64>() / all.len() as f64).collect()
        };
        let signals: Vec<Vec<f64>> = data.flights.iter().enumerate().map(mean).collect();
        let mut mean = Data::pick(&signals, chosen);
        mean.retain(|u| u.is_finite());
        [0.01, 0.99].map(|q| quantile(&mean, q))
    }
}
