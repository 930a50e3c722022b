//! A diagnosis as series to be drawn.

pub mod profile;
pub mod spectrum;
pub mod windows;

use super::Diagnosed;
use crate::base::stats::mean;
use crate::insight::criteria::shown::{FIGURE_FALL, FIGURE_SHARE};
use crate::insight::diagnose::prediction::channels::{CHANNELS, NAMES};
use crate::insight::diagnose::structure::Structure;
use crate::model::effects::Role;
use profile::Profile;
use spectrum::Spectra;
use windows::{Errors, Window};

/// Most channels that are shown.
const MOST: usize = 6;

/// Everything that is drawn of one channel. Before is the compact model, fitted to the flights; after is the same with
/// what was found.
pub struct ChannelFigure {
    pub name: &'static str,
    pub unit: &'static str,
    /// Root mean squares of the residual, and of what is unpredictable in it.
    pub before: f64,
    pub after: f64,
    pub noise: f64,
    /// The worst stretches of time before, the worst first.
    pub windows: Vec<Window>,
    /// Root mean squares of the residual over the flight.
    pub errors: Errors,
    /// The residual along the signal that explains most of it; none where none explains any.
    pub profile: Option<Profile>,
    pub spectra: Option<Spectra>,
}

/// The channels that a finding explains or that have structure, those with structure first, then by what was gained.
pub fn channels(diagnosed: &Diagnosed) -> Vec<ChannelFigure> {
    let shown = |c: usize, fell: f64| {
        let name = NAMES[c].0;
        // Constant errors of the IMU are part of the fit before as well as after: there is nothing to see in them.
        let findings = diagnosed.diagnosis.findings.iter().filter(|f| !f.has(Role::ConstantError));
        let explained = findings.filter_map(|f| f.explained.get(name)).any(|share| *share > FIGURE_SHARE.get());
        explained || fell > FIGURE_FALL.get() || unexplained(diagnosed, name)
    };
    let mut ranked: Vec<(bool, f64, usize)> = (0..CHANNELS)
        .filter(|&c| !diagnosed.selection.base.residual[c].is_empty())
        .map(|c| (unexplained(diagnosed, NAMES[c].0), fell(diagnosed, c), c))
        .filter(|(_, fell, c)| shown(*c, *fell))
        .collect();
    ranked.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
    ranked.into_iter().take(MOST).map(|(_, _, c)| channel(diagnosed, c)).collect()
}

fn unexplained(diagnosed: &Diagnosed, name: &str) -> bool {
    diagnosed.diagnosis.unexplained.iter().any(|s| s.channel == name)
}

fn fell(diagnosed: &Diagnosed, c: usize) -> f64 {
    let selection = &diagnosed.selection;
    1.0 - rms(&selection.point.residual[c]) / rms(&selection.base.residual[c]).max(1e-300)
}

fn rms(residual: &[f64]) -> f64 {
    mean(&residual.iter().map(|r| r * r).collect::<Vec<_>>()).sqrt()
}

fn channel(diagnosed: &Diagnosed, c: usize) -> ChannelFigure {
    let Diagnosed { diagnosis, problem, selection, .. } = diagnosed;
    let (name, unit) = NAMES[c];
    let (before, after) = (&selection.base.residual[c], &selection.point.residual[c]);
    let runs = windows::runs(problem, c);
    let windows = windows::worst(problem, c, &runs, [before, after]);
    let along = |all: &[Structure]| all.iter().find(|s| s.channel == name).and_then(|s| s.along);
    let signal = along(&diagnosis.structure_before).or(along(&diagnosis.structure));
    ChannelFigure {
        name,
        unit,
        before: rms(before),
        after: rms(after),
        noise: selection.whitener.sd(c),
        errors: windows::errors(problem, c, &windows, [before, after]),
        windows,
        profile: signal.and_then(|s| profile::along(problem, &selection.base.state, c, s, [before, after])),
        spectra: spectrum::spectra(&runs, [before, after]),
    }
}
