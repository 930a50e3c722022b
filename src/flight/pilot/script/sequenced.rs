//! Commands along a timetable: doublets, spins, punches, chops, ramps.

use super::{Now, Script};
use crate::base::rng::Sequence;
use crate::flight::pilot::PilotLimits;
use crate::flight::pilot::cascade::Demand;
use nalgebra::Vector3;
use rand::seq::SliceRandom;

/// A stretch of a timetable.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    pub seconds: f64,
    /// Command at its beginning and end; none leaves the axis to the cascade.
    pub command: Option<[f64; 2]>,
}

/// One axis along a timetable.
#[derive(Debug)]
pub struct Sequenced {
    axis: usize,
    segments: Vec<Segment>,
}

/// Sizes of the doublets of one manoeuvre, shares of the full rate.
const SIZES: [f64; 3] = [0.3, 0.6, 1.0];
/// Angle that each half of a doublet turns through, rad, and the shortest and longest that a half lasts, s.
const HALF_RAD: f64 = 1.1;
const HALF_S: [f64; 2] = [0.03, 0.3];

impl Sequenced {
    pub fn new(axis: usize, segments: Vec<Segment>) -> Self {
        Sequenced { axis, segments }
    }

    /// Rate doublets of three sizes in random order, beginning to the side of `sign`.
    pub fn doublets(axis: usize, sign: f64, limits: &PilotLimits, rng: &mut Sequence) -> Self {
        let mut sizes = SIZES;
        sizes.shuffle(rng);
        let segments = sizes.iter().flat_map(|size| {
            let seconds = HALF_RAD / (size * limits.max_rate_rad_s[axis]);
            let seconds = seconds.clamp(HALF_S[0], HALF_S[1]);
            let half = |value: f64| Segment { seconds, command: Some([value, value]) };
            [half(sign * size), half(-sign * size), Segment { seconds: 0.25, command: None }]
        });
        Self::new(axis, segments.collect())
    }
}

impl Script for Sequenced {
    fn demand(&mut self, now: &Now, _: &mut Sequence) -> Option<Demand> {
        let mut time = now.time;
        for segment in &self.segments {
            if time < segment.seconds - 1e-6 {
                let mut demand = Demand::at(Vector3::zeros());
                demand.direct[self.axis] =
                    segment.command.map(|[from, to]| from + (to - from) * time / segment.seconds);
                return Some(demand);
            }
            time -= segment.seconds;
        }
        None
    }
}
