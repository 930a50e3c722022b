//! A flight from above, coloured by speed, with the gates and the reset spline (the paper's Figures 2 and 5).

use super::map::{self, MapPoint};
use super::plot;
use crate::base::error::Result;
use crate::model::track::Track;
use crate::race::eval::fly::TraceStep;
use crate::race::reference::Reference;

const HEIGHT: u32 = 900;
/// Width of the colour scale, pixels.
const SCALE: u32 = 110;

/// An SVG of `trace` over the gates of `track`.
pub fn svg(track: &Track, trace: &[TraceStep], title: &str) -> Result<String> {
    let speed = |m: &TraceStep| f64::from(m.vx.powi(2) + m.vy.powi(2) + m.vz.powi(2)).sqrt();
    let places = trace.iter().map(|m| ((f64::from(m.x), f64::from(m.y)), speed(m))).collect();
    draw(track, places, title)
}

/// An SVG of a reference lap.
pub fn reference(track: &Track, lap: &Reference, title: &str) -> Result<String> {
    let closed = lap.moments.iter().chain(lap.moments.first());
    draw(track, closed.map(|m| ((m.position.x, m.position.y), m.velocity.norm())).collect(), title)
}

fn draw(track: &Track, places: Vec<(MapPoint, f64)>, title: &str) -> Result<String> {
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
