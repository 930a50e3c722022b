//! The error by frequency.

use super::{AFTER, BEFORE};
use crate::base::error::Result;
use crate::insight::diagnose::figures::ChannelFigure;
use crate::insight::diagnose::figures::spectrum::Spectra;
use crate::present::report::drawing;
use crate::present::report::page::unit;
use crate::present::report::plot::{self, TEXT, line};
use plotters::prelude::*;

/// Power densities, both axes logarithmic.
pub fn draw(channel: &ChannelFigure, spectra: &Spectra) -> Result<String> {
    plot::keyed(320, &super::lines(), |root| {
        let both = || spectra.before.iter().chain(&spectra.after).copied().filter(|p| *p > 0.0);
        let (low, high) = (both().fold(f64::INFINITY, f64::min), both().fold(0.0, f64::max));
        let (low, high) = if high > 0.0 { (low / 2.0, high * 3.0) } else { (0.1, 1.0) };
        let x = spectra.hz[0]..spectra.hz[spectra.hz.len() - 1];
        let mut chart = ChartBuilder::on(root)
            .margin(8)
            .x_label_area_size(42)
            .y_label_area_size(84)
            .build_cartesian_2d(x.log_scale(), (low..high).log_scale())
            .map_err(drawing)?;
        let name = unit(channel.unit);
        let squared = if name.contains('/') { format!("({name})²") } else { format!("{name}²") };
        chart
            .configure_mesh()
            .light_line_style(BLACK.mix(0.04))
            .bold_line_style(BLACK.mix(0.08))
            .label_style(("sans-serif", TEXT))
            .x_desc("frequency, Hz")
            .y_desc(format!("power density, {squared}/Hz"))
            .x_label_formatter(&|x| format!("{}", (x * 1e3).round() / 1e3))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .y_labels(6)
            .draw()
            .map_err(drawing)?;
        for (power, colour) in [(&spectra.before, BEFORE), (&spectra.after, AFTER)] {
            let points = spectra.hz.iter().copied().zip(power.iter().copied()).filter(|p| p.1 > 0.0);
            line(&mut chart, points, colour.stroke_width(2))?;
        }
        Ok(())
    })
}
