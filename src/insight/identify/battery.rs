//! Discharge: a line through the voltage in flight.

use super::rates::times;
use super::solve::{Solution, Unknown, solve};
use crate::flight::series::last_at;
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::dynamics::battery::discharged;
use crate::model::vehicle::Battery;

/// Order of the unknowns: rate (V/s), then the voltage at the beginning of each flight (V).
pub const RATE: usize = 0;
pub const INITIAL: usize = 1;

/// When the flight of each log begins, s.
fn beginnings(data: &Data) -> Vec<f64> {
    data.flights.iter().map(|f| f.quality.usable.first().map_or(0.0, |span| span[0])).collect()
}

/// The voltage as measured, at the one IMU sample nearest after each measurement; NaN elsewhere.
fn measured(data: &Data) -> Vec<Vec<f64>> {
    data.signals(|flight| {
        let mut out = vec![f64::NAN; flight.time.len()];
        let battery = &flight.quality.log.battery;
        for (t, row) in battery.time_s.iter().zip(&battery.rows) {
            let next = last_at(&flight.time, *t).map_or(0, |i| i + 1);
            if next < out.len() && row[0] > 0.0 {
                out[next] = row[0];
            }
        }
        out
    })
}

/// Fits one rate and each flight's initial voltage.
pub fn fit(data: &Data, part: DataPart) -> Option<Solution> {
    let measured = measured(data);
    let chosen = data.choose(part, |f, i| measured[f][i].is_finite());
    let (values, times, blocks) = (Data::pick(&measured, &chosen), times(data, &chosen), data.blocks(&chosen));
    let first = *values.first()?;
    let flight: Vec<usize> = chosen.iter().enumerate().flat_map(|(f, c)| vec![f; c.len()]).collect();
    let begins = beginnings(data);
    // A flight without a sample in this part keeps its start.
    let mut unknowns =
        vec![Unknown { start: first, low: 0.0, high: 1000.0, step: 1e-2, linear: true }; 1 + data.flights.len()];
    unknowns[RATE] = Unknown { start: 0.0, low: -10.0, high: 10.0, step: 1e-4, linear: true };
    let residuals = |x: &[f64]| {
        let line = |i: usize| discharged(x[INITIAL + flight[i]], x[RATE], times[i] - begins[flight[i]]);
        vec![(0..values.len()).map(|i| line(i) - values[i]).collect()]
    };
    solve(&unknowns, &blocks, &residuals)
}

/// The pack that the line describes: from the highest start to as low as was flown, and at least as far as `base` flies
/// its own.
pub fn pack(data: &Data, part: DataPart, fit: &Solution, base: &Battery) -> Battery {
    let begins = beginnings(data);
    let line = |f: usize, t: f64| discharged(fit.values[INITIAL + f], fit.values[RATE], t - begins[f]);
    let chosen = data.choose(part, |_, _| true);
    let ends = data.flights.iter().zip(&chosen).enumerate().filter_map(|(f, (flight, chosen))| {
        let [first, last] = [chosen.first()?, chosen.last()?].map(|&i| flight.time[i]);
        Some([line(f, first), line(f, last)])
    });
    let ends: Vec<[f64; 2]> = ends.collect();
    let full_v = ends.iter().map(|e| e[0].max(e[1])).fold(f64::NEG_INFINITY, f64::max);
    let lowest = ends.iter().map(|e| e[0].min(e[1])).fold(f64::INFINITY, f64::min);
    let empty_v = lowest.min(full_v * base.empty_v / base.full_v);
    Battery { full_v, empty_v, rate_v_s: fit.values[RATE].min(0.0) }
}
