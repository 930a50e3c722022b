//! Errors of the open loop.

use super::{AFTER, BEFORE};
use crate::base::error::Result;
use crate::insight::diagnose::judgement::diagnosis::Ahead;
use crate::insight::diagnose::prediction::horizon::Horizon;
use crate::present::report::drawing;
use crate::present::report::plot::{self, Area, TEXT};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type HorizonValue = fn(&Horizon) -> f64;

/// Bars before and after, one panel a quantity.
pub fn draw(ahead: &[Ahead]) -> Result<String> {
    let panels: [(&str, HorizonValue); 3] = [
        ("velocity, m/s off", |h| h.velocity_m_s),
        ("position, m off", |h| h.position_m),
        ("attitude, deg off", |h| h.attitude_deg),
    ];
    plot::keyed(280, &super::lines().map(|(name, style)| (name, style.stroke_width(10))), |root| {
        for (area, (name, of)) in root.split_evenly((1, panels.len())).iter().zip(panels) {
            panel(area, name, of, ahead)?;
        }
        Ok(())
    })
}

fn panel(area: &Area, name: &str, of: HorizonValue, ahead: &[Ahead]) -> Result<()> {
    let top = ahead.iter().flat_map(|a| [of(&a.before), of(&a.after)]).fold(1e-9, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(name, ("sans-serif", 18))
        .margin(6)
        .x_label_area_size(42)
        .y_label_area_size(52)
        .build_cartesian_2d(-0.5..ahead.len() as f64 - 0.5, 0.0..1.1 * top)
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.08))
        .label_style(("sans-serif", TEXT))
        .x_labels(0)
        .y_labels(5)
        .x_desc("left alone for")
        .draw()
        .map_err(drawing)?;
    type Side = fn(&Ahead) -> &Horizon;
    let sides: [(RGBColor, f64, Side); 2] = [(BEFORE, -0.36, |a| &a.before), (AFTER, 0.04, |a| &a.after)];
    for (colour, side, of_side) in sides {
        let bar = |(i, a): (usize, &Ahead)| {
            let from = i as f64 + side;
            Rectangle::new([(from, 0.0), (from + 0.32, of(of_side(a)))], colour.filled())
        };
        chart.draw_series(ahead.iter().enumerate().map(bar)).map_err(drawing)?;
    }
    let font = ("sans-serif", TEXT).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Top));
    for (i, a) in ahead.iter().enumerate() {
        let (x, y) = chart.backend_coord(&(i as f64, 0.0));
        area_text(area, &format!("{} s", a.before.after_s), (x, y + 6), &font)?;
    }
    Ok(())
}

/// Text at a place of the whole figure.
fn area_text(area: &Area, text: &str, at: (i32, i32), font: &TextStyle) -> Result<()> {
    let (x, y) = area.get_pixel_range();
    area.draw_text(text, font, (at.0 - x.start, at.1 - y.start)).map_err(drawing)
}
