//! Commands over the first seconds of two flights, side by side (the paper's Figure 6).

use super::drawing;
use super::plot::{self, BLUE, ORANGE, TEXT};
use crate::base::error::Result;
use crate::race::eval::fly::{JUDGED_STEPS, SATURATED, TraceStep};
use plotters::prelude::*;

/// A flight and what to call it.
#[derive(Clone, Copy, Debug)]
pub struct Commands<'a> {
    pub title: &'a str,
    pub trace: &'a [TraceStep],
}

const HEIGHT: u32 = 760;
/// Height of the line of titles, pixels.
const TITLES: u32 = 30;
const SECONDS: f64 = JUDGED_STEPS as f64 * crate::model::constants::CONTROL_S;

/// An SVG: roll, pitch and yaw rate and thrust, each from -1 to 1, of the `flights` (in the paper one with weak and one
/// with strong regularisation); the limits of saturation are marked.
pub fn svg(flights: &[Commands]) -> Result<String> {
    const NAMES: [&str; 4] = ["roll rate", "pitch rate", "yaw rate", "thrust"];
    plot::svg(HEIGHT, |root| {
        let columns = root.split_evenly((1, flights.len()));
        for (area, Commands { title, trace }) in columns.iter().zip(flights) {
            let (head, rest) = area.split_vertically(TITLES);
            let font = ("sans-serif", 18).into_font().color(&BLACK);
            head.draw(&Text::new(title.to_string(), (64, 8), font)).map_err(drawing)?;
            for (k, row) in rest.split_evenly((4, 1)).iter().enumerate() {
                let last = k == 3;
                let mut chart = ChartBuilder::on(row)
                    .margin_right(16)
                    .margin_top(8)
                    .x_label_area_size(if last { 44 } else { 14 })
                    .y_label_area_size(64)
                    .build_cartesian_2d(0.0..SECONDS, -1.08..1.08)
                    .map_err(drawing)?;
                let labels = |x: &f64| if last { format!("{x:.0}") } else { String::new() };
                chart
                    .configure_mesh()
                    .light_line_style(TRANSPARENT)
                    .bold_line_style(BLACK.mix(0.08))
                    .label_style(("sans-serif", TEXT))
                    .x_desc(if last { "time, s" } else { "" })
                    .y_desc(NAMES[k])
                    .x_labels(5)
                    .x_label_formatter(&labels)
                    .y_labels(3)
                    .y_label_formatter(&|y| format!("{y:.0}"))
                    .draw()
                    .map_err(drawing)?;
                for limit in [-SATURATED, SATURATED] {
                    plot::line(&mut chart, [(0.0, limit), (SECONDS, limit)], ORANGE.mix(0.5).stroke_width(1))?;
                }
                plot::line(&mut chart, steps(trace, k), BLUE.stroke_width(2))?;
            }
        }
        Ok(())
    })
}

/// Command `k` as it was held.
fn steps(trace: &[TraceStep], k: usize) -> Vec<(f64, f64)> {
    let command = |m: &TraceStep| f64::from([m.roll, m.pitch, m.yaw, m.thrust][k]);
    let kept: Vec<_> = trace.iter().take_while(|m| m.time_s <= SECONDS).collect();
    let held = kept.windows(2).flat_map(|pair| [pair[0].time_s, pair[1].time_s].map(|time| (time, command(pair[0]))));
    held.collect()
}
