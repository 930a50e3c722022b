//! Colours and shapes that readers of every kind of colour vision tell apart, and their keys.

use crate::base::error::Result;
use crate::present::report::drawing;
use crate::present::report::plot::{Area, Linear, On, TEXT};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Okabe and Ito's colours.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 80, 140),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];
/// Height of a line of a key, pixels.
pub const LINE: i32 = 22;

/// Colour of the setting in this place among those shown.
pub fn colour(place: usize) -> RGBColor {
    COLOURS[place % COLOURS.len()]
}

/// A shape in pixels around a point.
pub fn section(place: usize) -> Vec<(i32, i32)> {
    const SHAPES: [&[(i32, i32)]; 4] = [
        &[(0, -7), (7, 5), (-7, 5)],
        &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
        &[(0, -7), (7, 0), (0, 7), (-7, 0)],
        &[(-7, -5), (7, -5), (0, 7)],
    ];
    SHAPES[place % SHAPES.len()].to_vec()
}

/// A star of this radius.
pub fn star(radius: f64) -> Vec<(i32, i32)> {
    let corner = |i: usize| {
        let angle = std::f64::consts::PI * (i as f64 / 5.0 - 0.5);
        let r = if i.is_multiple_of(2) { radius } else { 0.42 * radius };
        ((r * angle.cos()).round() as i32, (r * angle.sin()).round() as i32)
    };
    (0..10).map(corner).collect()
}

/// Draws a shape at a point of a chart, filled, with a thin edge.
pub fn draw(
    chart: &mut On<Linear, Linear>,
    at: (f64, f64),
    shape: &[(i32, i32)],
    [fill, edge]: [RGBColor; 2],
) -> Result<()> {
    let around: Vec<_> = shape.iter().chain(shape.first()).copied().collect();
    let mark = EmptyElement::at(at) + Polygon::new(shape.to_vec(), fill.filled()) + PathElement::new(around, edge);
    chart.draw_series([mark]).map_err(drawing)?;
    Ok(())
}

/// A key: lines with names in the first rows, shapes with names in the last.
pub struct Key {
    pub lines: Vec<(RGBColor, String)>,
    pub shapes: Vec<(Vec<(i32, i32)>, String)>,
}

impl Key {
    /// Height in pixels.
    pub fn height(&self) -> i32 {
        LINE * (self.lines.len() as i32 + i32::from(!self.shapes.is_empty())) + 8
    }

    /// Draws it from the top of `area` down.
    pub fn draw(&self, area: &Area) -> Result<()> {
        let font = || ("sans-serif", TEXT).into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
        let mut y = LINE / 2 + 4;
        for (colour, name) in &self.lines {
            area.draw(&PathElement::new([(76, y), (108, y)], colour.stroke_width(3))).map_err(drawing)?;
            area.draw(&Text::new(name.clone(), (118, y), font())).map_err(drawing)?;
            y += LINE;
        }
        let mut x = 84;
        for (shape, name) in &self.shapes {
            let placed: Vec<_> = shape.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
            area.draw(&Polygon::new(placed, WHITE.mix(0.0).filled())).map_err(drawing)?;
            let edge: Vec<_> = shape.iter().chain(shape.first()).map(|(dx, dy)| (x + dx, y + dy)).collect();
            area.draw(&PathElement::new(edge, BLACK.stroke_width(2))).map_err(drawing)?;
            area.draw(&Text::new(name.clone(), (x + 14, y), font())).map_err(drawing)?;
            x += 40 + 8 * name.len() as i32;
        }
        Ok(())
    }
}
