//! Two laps over each other, as benchmarks draw them.

use super::plot::{self, BLUE, ORANGE};
use super::{drawing, map};
use crate::base::error::Result;
use crate::model::constants::CONTROL_S;
use crate::model::track::Track;
use plotters::prelude::{ChartBuilder, Color};

/// Height of the map, and of the speeds below it, pixels.
const HEIGHT: u32 = 900;
const SPEEDS: u32 = 260;

/// An SVG of two flights over each other, each with a name and its positions, m, and velocities, m/s, every 10 ms;
/// below, their speeds.
pub fn svg(track: &Track, flights: &[(&str, &[[f64; 6]]); 2], title: &str) -> Result<String> {
    let styles = [BLUE.stroke_width(4), ORANGE.stroke_width(2)];
    let keys: Vec<_> = flights.iter().zip(styles).map(|((name, _), style)| (*name, style)).collect();
    plot::keyed(HEIGHT + SPEEDS, &keys, |root| {
        let (above, below) = root.split_vertically(HEIGHT);
        let flat = |p: &[f64; 6]| (p[0], p[1]);
        let speed = |p: &[f64; 6]| p[3].hypot(p[4]).hypot(p[5]);
        let mut chart = map::chart(&above, track, flights.iter().flat_map(|f| f.1.iter().map(flat)), title)?;
        let longest = flights.iter().map(|f| f.1.len()).max().unwrap_or(1) as f64 * CONTROL_S;
        let top = flights.iter().flat_map(|f| f.1.iter().map(speed)).fold(1.0, f64::max);
        let mut speeds = ChartBuilder::on(&below)
            .margin(12)
            .x_label_area_size(46)
            .y_label_area_size(66)
            .build_cartesian_2d(0.0..longest, 0.0..1.05 * top)
            .map_err(drawing)?;
        plot::mesh(&mut speeds, "time, s", "speed, m/s", [10, 5])?;
        for ((_, path), style) in flights.iter().zip(styles) {
            map::path(&mut chart, path.iter().map(flat), style)?;
            plot::line(&mut speeds, path.iter().enumerate().map(|(i, p)| (i as f64 * CONTROL_S, speed(p))), style)?;
        }
        map::gates(&mut chart, track)
    })
}
