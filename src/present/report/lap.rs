//! A flight from above, coloured by speed, with the gates and the reset spline (the paper's Figures 2 and 5).

use super::drawing;
use super::map::{self, Place};
use super::plot::{self, BLUE, ORANGE};
use crate::base::error::Result;
use crate::model::constants::CONTROL_S;
use crate::model::track::Track;
use crate::race::eval::fly::Moment;
use crate::race::reference::Reference;
use plotters::prelude::{ChartBuilder, Color};

const HEIGHT: u32 = 900;
/// Width of the colour scale, pixels.
const SCALE: u32 = 110;

/// An SVG of `trace` over the gates of `track`.
pub fn svg(track: &Track, trace: &[Moment], title: &str) -> Result<String> {
    let speed = |m: &Moment| f64::from(m.vx.powi(2) + m.vy.powi(2) + m.vz.powi(2)).sqrt();
    let places = trace.iter().map(|m| ((f64::from(m.x), f64::from(m.y)), speed(m))).collect();
    draw(track, places, title)
}

/// An SVG of a reference lap.
pub fn reference(track: &Track, lap: &Reference, title: &str) -> Result<String> {
    let closed = lap.moments.iter().chain(lap.moments.first());
    draw(track, closed.map(|m| ((m.position.x, m.position.y), m.velocity.norm())).collect(), title)
}

/// Height of the speeds below two laps, pixels.
const SPEEDS: u32 = 260;

/// An SVG of two flights over each other, each with a name and its positions, m, and velocities, m/s, every 10 ms; below, their speeds.
pub fn beside(track: &Track, flights: &[(&str, &[[f64; 6]]); 2], title: &str) -> Result<String> {
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

fn draw(track: &Track, places: Vec<(Place, f64)>, title: &str) -> Result<String> {
    plot::svg(HEIGHT, |root| {
        let (area, scale) = root.split_horizontally(plot::WIDTH - SCALE);
        let top = places.iter().map(|(_, speed)| *speed).fold(1.0, f64::max);
        let mut chart = map::chart(&area, track, places.iter().map(|(place, _)| *place), title)?;
        map::spline(&mut chart, track)?;
        map::coloured(&mut chart, &places, top)?;
        map::gates(&mut chart, track)?;
        map::scale(&scale, top)
    })
}
