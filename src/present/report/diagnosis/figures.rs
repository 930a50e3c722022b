//! Figures of a diagnosis: one file a kind.

mod horizons;
mod profile;
mod spectrum;
mod time;

use crate::base::error::Result;
use crate::insight::diagnose::Diagnosed;
use crate::insight::diagnose::figures::{ChannelFigure, channels};
use crate::insight::diagnose::judgement::diagnosis::Ahead;
use crate::present::report::plot::{BLUE, ORANGE};
use plotters::style::{Color, RGBColor, ShapeStyle};

/// The compact model, and the same with what was found, in every figure.
const BEFORE: RGBColor = ORANGE;
const AFTER: RGBColor = BLUE;

/// Both as the lines of a figure.
fn lines() -> [(&'static str, ShapeStyle); 2] {
    [("before", BEFORE.stroke_width(2)), ("after", AFTER.stroke_width(2))]
}

/// A figure that stands alone.
pub struct Figure {
    /// What its file is called, without ending.
    pub name: String,
    /// What it shows.
    pub caption: String,
    pub svg: String,
}

/// A channel and its figures.
pub struct ChannelFigures {
    pub channel: ChannelFigure,
    pub figures: Vec<Figure>,
}

/// All figures of the diagnosis: of its channels, and of the open loop where the flights allow it.
pub struct DiagnosisFigures {
    pub channels: Vec<ChannelFigures>,
    pub open_loop: Option<Figure>,
}

impl DiagnosisFigures {
    pub fn new(diagnosed: &Diagnosed) -> Result<Self> {
        let shown =
            channels(diagnosed).into_iter().map(|channel| Ok(ChannelFigures { figures: of(&channel)?, channel }));
        let ahead = &diagnosed.diagnosis.horizons;
        let open_loop = (!ahead.is_empty()).then(|| open_loop(ahead)).transpose()?;
        Ok(Self { channels: shown.collect::<Result<_>>()?, open_loop })
    }

    /// One after the other.
    pub fn all(&self) -> impl Iterator<Item = &Figure> {
        self.channels.iter().flat_map(|shown| &shown.figures).chain(&self.open_loop)
    }
}

fn of(channel: &ChannelFigure) -> Result<Vec<Figure>> {
    let name = |kind: &str| format!("{}-{kind}", channel.name.replace(' ', "-"));
    let mut out = Vec::new();
    if !channel.windows.is_empty() {
        let caption =
            "The stretches that the simulation predicts worst without what was found, and its error over the \
            whole flight (root mean square of each second) with these stretches marked."
                .into();
        out.push(Figure { name: name("time"), caption, svg: time::draw(channel)? });
    }
    if let Some(p) = &channel.profile {
        let caption = format!(
            "The error along the {}: mean at levels that are equally often met, with its 95 % interval.",
            p.signal
        );
        out.push(Figure { name: name("profile"), caption, svg: profile::draw(channel, p)? });
    }
    if let Some(s) = &channel.spectra {
        let caption = "The error by frequency: what is slow is the model's, what is even is noise.".into();
        out.push(Figure { name: name("spectrum"), caption, svg: spectrum::draw(channel, s)? });
    }
    Ok(out)
}

fn open_loop(ahead: &[Ahead]) -> Result<Figure> {
    let caption =
        "How far the simulation strays from the flight, left alone with the logged commands: root mean squares \
        over many starts."
            .into();
    Ok(Figure { name: "open-loop".into(), caption, svg: horizons::draw(ahead)? })
}
