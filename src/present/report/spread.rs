//! Randomised flights over the nominal one, and where they spread (the paper's Figure 7).

use super::drawing;
use super::map;
use super::plot::{self, BLUE, ORANGE, TEXT};
use crate::base::error::Result;
use crate::model::track::Track;
use crate::race::eval::spread::Spread;
use nalgebra::Vector3;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const MAP: u32 = 880;
const PROFILE: u32 = 330;
/// Of the randomised vehicles' places, 10 ms apart, every so many are drawn.
const THINNED: usize = 3;

/// An SVG: from above, and below it the distance from the nominal flight along it.
pub fn svg(track: &Track, spread: &Spread, title: &str) -> Result<String> {
    let count = format!("{} randomised vehicles", spread.randomised.len());
    let keys = [
        (count.as_str(), BLUE.mix(0.5).stroke_width(2)),
        ("nominal vehicle", BLACK.stroke_width(3)),
        ("reset spline (dotted)", BLACK.mix(0.3).stroke_width(1)),
    ];
    plot::keyed(MAP + PROFILE, &keys, |root| {
        let (above, below) = root.split_vertically(MAP);
        let flat = |p: &Vector3<f64>| (p.x, p.y);
        let all = spread.randomised.iter().chain([&spread.nominal]);
        let mut chart = map::chart(&above, track, all.flatten().map(flat), title)?;
        map::spline(&mut chart, track)?;
        for path in &spread.randomised {
            map::path(&mut chart, path.iter().step_by(THINNED).map(flat), BLUE.mix(0.22).stroke_width(1))?;
        }
        map::path(&mut chart, spread.nominal.iter().map(flat), BLACK.stroke_width(3))?;
        map::gates(&mut chart, track)?;
        draw_profile(&below, track, spread)
    })
}

fn draw_profile(area: &plot::Area, track: &Track, spread: &Spread) -> Result<()> {
    let profile = &spread.profile;
    let length = profile.last().map_or(1.0, |s| s.at_m);
    let most = profile.iter().map(|s| s.p90_m).fold(0.1, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_top(30)
        .x_label_area_size(46)
        .y_label_area_size(66)
        .build_cartesian_2d(0.0..length, 0.0..1.12 * most)
        .map_err(drawing)?;
    plot::mesh(&mut chart, "length of the nominal flight, m", "distance from it, m", [10, 5])?;
    let font = ("sans-serif", TEXT).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Bottom));
    let mut free = f64::NEG_INFINITY;
    for &(at, gate) in &spread.gates {
        plot::line(&mut chart, [(at, 0.0), (at, 1.12 * most)], BLACK.mix(0.25).stroke_width(1))?;
        // Of gates that are passed close to each other, the first is named.
        if at > free {
            let label = Text::new(track.gate_label(gate), (at, 1.13 * most), font.clone());
            chart.draw_series([label]).map_err(drawing)?;
            free = at + 0.028 * length;
        }
    }
    let upper = || profile.iter().map(|s| (s.at_m, s.p90_m));
    let ends = [profile.last(), profile.first()].into_iter().flatten().map(|s| (s.at_m, 0.0));
    let band = Polygon::new(upper().chain(ends).collect::<Vec<_>>(), BLUE.mix(0.2).filled());
    chart.draw_series([band]).map_err(drawing)?;
    plot::line(&mut chart, upper(), BLUE.stroke_width(1))?;
    plot::line(&mut chart, profile.iter().map(|s| (s.at_m, s.median_m)), BLACK.stroke_width(2))?;
    if let Some(widest) = spread.widest() {
        let dot = Circle::new((widest.at_m, widest.p90_m), 5, ORANGE.filled());
        chart.draw_series([dot]).map_err(drawing)?;
    }
    let text = ("sans-serif", TEXT).into_font().color(&BLACK);
    let said = spread.widest().map_or(String::new(), |s| {
        format!("; widest, {:.2} m, at {:.0} m on the way to gate {}", s.p90_m, s.at_m, track.gate_label(s.gate))
    });
    area.draw(&Text::new(format!("median (black) and 90 % (blue) of the vehicles{said}"), (72, 2), text))
        .map_err(drawing)
}
