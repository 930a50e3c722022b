//! What each error of the model costs: success and lap time as one parameter alone leaves its nominal value.

mod parameter;

pub use parameter::Parameter;

use super::EvalConfig;
use super::fly::{Fleet, fly_fleet};
use super::score::score;
use crate::base::lane::Level;
use crate::learn::nn::Network;
use crate::model::dynamics::Factors;
use crate::model::track::Track;
use crate::race::env::Race;
use crate::race::env::reset::StartPlace;
use serde::Serialize;

/// How a policy does as one parameter at a time is wrong.
#[derive(Clone, Debug, Serialize)]
pub struct Sensitivity {
    /// Flights in each cell; the same noise in all.
    pub agents: usize,
    pub nominal: Cell,
    /// The costliest parameter first.
    pub parameters: Vec<Row>,
}

/// One parameter.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub parameter: String,
    /// The range that the policy was trained on.
    pub trained: [f64; 2],
    /// Mean over all values of the completion that is lost against the nominal vehicle's.
    pub loss: f64,
    /// The slowest median lap less the nominal vehicle's, s.
    pub slower_s: Option<f64>,
    /// Values around the nominal one from the least to the greatest without one between them that completes fewer than
    /// 95 % of laps.
    pub holds: Option<[f64; 2]>,
    pub cells: Vec<Cell>,
}

/// All flights with one value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cell {
    pub value: f64,
    pub completion: f64,
    /// Median lap, s.
    pub lap_s: Option<f64>,
}

/// Flies `config.agents` agents from the pad for each value of each parameter: the apertures are those of a score,
/// observations and actions have the noise of the training. Without it all flights of a cell would be the same flight.
/// `observer` is told the share that is done. Runs on the current rayon pool.
pub fn sensitivity(
    level: Level,
    race: &Race,
    track: &Track,
    network: &Network<f32>,
    config: &EvalConfig,
    observer: &mut dyn FnMut(f64),
) -> Sensitivity {
    let race = Race { noisy: true, ..race.scored(track) };
    let cell = |(factors, charge): (Factors, f64), value: f64| {
        let steps = config.max_steps as u32;
        let flights =
            fly_fleet(level, &race, network, StartPlace::Pad, Fleet::Same(&factors, charge), config.agents, steps);
        let scored = score(track, &flights);
        Cell { value, completion: scored.lap_completion, lap_s: scored.lap_time_s.map(|time| time.median) }
    };
    let nominal = cell((Factors::NOMINAL, 1.0), 1.0);
    let all = Parameter::all();
    let mut parameters = Vec::new();
    for (done, parameter) in all.iter().enumerate() {
        observer(done as f64 / all.len() as f64);
        let cells: Vec<Cell> = parameter
            .values()
            .into_iter()
            .map(|value| if value == 1.0 { nominal } else { cell(parameter.vehicle(value), value) })
            .collect();
        parameters.push(Row {
            parameter: parameter.name(),
            trained: parameter.trained(&race.config.randomize),
            loss: cells.iter().map(|cell| nominal.completion - cell.completion).sum::<f64>() / cells.len() as f64,
            slower_s: slowest(&cells).zip(nominal.lap_s).map(|(slowest, nominal)| slowest - nominal),
            holds: holds(&cells),
            cells,
        });
    }
    // Of those that cost no laps, the one that costs most time.
    let cost = |row: &Row| [row.loss, row.slower_s.unwrap_or(f64::INFINITY)];
    parameters.sort_by(|a, b| cost(b).partial_cmp(&cost(a)).unwrap_or(std::cmp::Ordering::Equal));
    Sensitivity { agents: config.agents, nominal, parameters }
}

fn slowest(cells: &[Cell]) -> Option<f64> {
    cells.iter().filter_map(|cell| cell.lap_s).reduce(f64::max)
}

/// The values around 1 that are all good enough.
fn holds(cells: &[Cell]) -> Option<[f64; 2]> {
    let good = |cell: &&Cell| cell.completion >= super::choose::DEPLOYABLE;
    let nominal = cells.iter().position(|cell| cell.value == 1.0)?;
    let low = cells[..=nominal].iter().rev().take_while(good).last()?;
    let high = cells[nominal..].iter().take_while(good).last()?;
    Some([low.value, high.value])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_holds_ends_at_the_first_failure() {
        let cells = |completions: [f64; 5]| -> Vec<Cell> {
            let values = [0.8, 0.9, 1.0, 1.1, 1.2];
            values
                .into_iter()
                .zip(completions)
                .map(|(value, completion)| Cell { value, completion, lap_s: None })
                .collect()
        };
        assert_eq!(holds(&cells([1.0, 0.5, 0.96, 0.95, 0.2])), Some([1.0, 1.1]));
        assert_eq!(holds(&cells([1.0; 5])), Some([0.8, 1.2]));
        assert_eq!(holds(&cells([1.0, 1.0, 0.9, 1.0, 1.0])), None);
    }
}
