//! The shape of a track's reset spline: how long, and how sharp where.

use super::Track;
use super::spline::Spline;

/// Length and sharpest place of a closed curve.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Shape {
    /// m
    pub length_m: f64,
    /// Largest curvature, 1/m, and where it is, m along the curve and in the world.
    pub curvature_1_m: f64,
    pub at_m: f64,
    pub position_m: [f64; 3],
    /// The gate that comes next there.
    pub gate: usize,
}

/// Places that a curve is looked at in. The sharpest is found to a few centimetres.
const PLACES: usize = 8192;

impl Track {
    /// The spline that episodes start along (paper section 4.5): from the start through all gate centres and back.
    pub fn reset_spline(&self) -> Spline {
        let start = self.start.position();
        Spline::through(&std::iter::once(start).chain(self.centres()).collect::<Vec<_>>())
    }

    /// The gate that comes next at a place of the [`Track::reset_spline`] whose next control point is `next`.
    pub fn gate_after(&self, next: usize) -> usize {
        // Control point 0 is the start, whose next gate is the first.
        next.saturating_sub(1)
    }

    /// The shape of the [`Track::reset_spline`].
    pub fn shape(&self) -> Shape {
        let spline = self.reset_spline();
        let places = spline.samples(PLACES).into_iter();
        let sharp = places.map(|place| (spline.curvature(place.arc_length), place));
        // A curve has places.
        let (curvature, place) = sharp.max_by(|(a, _), (b, _)| a.total_cmp(b)).expect("places");
        Shape {
            length_m: spline.length(),
            curvature_1_m: curvature,
            at_m: place.arc_length,
            position_m: place.position.into(),
            gate: self.gate_after(place.next),
        }
    }
}
