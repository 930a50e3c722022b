//! The error along the signal that explains most of it.

use super::{AFTER, BEFORE};
use crate::base::error::Result;
use crate::base::stats::NORMAL_95;
use crate::insight::diagnose::figures::ChannelFigure;
use crate::insight::diagnose::figures::profile::{Profile, ProfileLevel};
use crate::present::report::drawing;
use crate::present::report::page::unit;
use crate::present::report::plot::{self, line, mesh, range};
use plotters::prelude::*;

/// Means with error bars, before and after.
pub fn draw(channel: &ChannelFigure, profile: &Profile) -> Result<String> {
    type ProfileSide = fn(&ProfileLevel) -> [f64; 2];
    let sides: [(ProfileSide, RGBColor); 2] = [(|l| l.before, BEFORE), (|l| l.after, AFTER)];
    plot::keyed(320, &super::lines(), |root| {
        let x = range(profile.levels.iter().map(|l| l.signal));
        let ends = |[mean, error]: [f64; 2]| [mean - NORMAL_95 * error, mean + NORMAL_95 * error];
        let y = range(profile.levels.iter().flat_map(|l| [ends(l.before), ends(l.after)]).flatten().chain([0.0]));
        // Bars of both stand side by side.
        let apart = 0.002 * (x.end - x.start);
        let mut chart = ChartBuilder::on(root)
            .margin(8)
            .x_label_area_size(42)
            .y_label_area_size(70)
            .build_cartesian_2d(x.clone(), y)
            .map_err(drawing)?;
        let label = format!("{}, {}", profile.signal, unit(profile.unit));
        mesh(&mut chart, &label, &format!("mean error, {}", unit(channel.unit)), [10, 6])?;
        line(&mut chart, [(x.start, 0.0), (x.end, 0.0)], BLACK.mix(0.5).stroke_width(1))?;
        for ((of, colour), side) in sides.into_iter().zip([-apart, apart]) {
            let points = || profile.levels.iter().map(|l| (l.signal + side, of(l)));
            line(&mut chart, points().map(|(x, y)| (x, y[0])), colour.stroke_width(2))?;
            for (x, y) in points() {
                let [low, high] = ends(y);
                let bar = PathElement::new([(x, low), (x, high)], colour.stroke_width(3));
                chart.draw_series([bar]).map_err(drawing)?;
                chart.draw_series([Circle::new((x, y[0]), 4, colour.filled())]).map_err(drawing)?;
            }
        }
        Ok(())
    })
}
