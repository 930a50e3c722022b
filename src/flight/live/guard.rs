//! What has to hold for a policy to have a vehicle.

use super::phase::Reason;
use crate::model::attitude::body_axes;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::race::env::observe::OBSERVATIONS;
use crate::race::onboard::Estimate;

/// Oldest state to fly by, s: five periods, a metre at 20 m/s.
pub const STALE_S: f64 = 0.05;
/// Farthest from the pad to start, m, fastest, m/s, and largest angle to the pad's attitude, rad: within the spread
/// that a vehicle put down by hand has.
const START_M: f32 = 0.5;
const REST_M_S: f32 = 0.3;
const TILT_RAD: f32 = 0.35;
/// Share of the training's range that may lie beyond either end of it: the vehicle is a little another than the trained
/// one, and a wrong frame is farther off.
const OUTSIDE_MARGIN: f32 = 0.1;
/// Periods outside the training's range before the flight ends: a gust leaves it for one, a wrong frame for all.
pub const OUTSIDE_STEPS: u32 = 20;
/// How much farther than its velocity says an estimate may move, m, and how much faster it may be, m/s.
const JUMP_M: f32 = 0.3;
const JUMP_M_S: f32 = 10.0;

/// The course's and the vehicle's.
#[derive(Clone, Debug)]
pub struct Limits {
    start: [f32; 3],
    /// The pad's forward axis.
    heading: [f32; 2],
    volume: [[f32; 3]; 2],
    empty_v: f32,
}

impl Limits {
    /// Of `track` and `vehicle`.
    pub fn of(track: &Track, vehicle: &Vehicle) -> Self {
        let (sin, cos) = track.start.heading_rad().sin_cos();
        let volume = [track.volume.min_m, track.volume.max_m].map(|corner| corner.map(|x| x as f32));
        Self {
            start: track.start.position_m.map(|x| x as f32),
            heading: [cos as f32, sin as f32],
            volume,
            empty_v: vehicle.battery.empty_v as f32,
        }
    }
}

/// The limits, and what was seen before.
#[derive(Clone, Debug)]
pub struct Guard {
    limits: Limits,
    last: Option<(f64, Estimate)>,
    jumped: bool,
    outside: u32,
}

impl Guard {
    pub fn new(limits: Limits) -> Self {
        Self { limits, last: None, jumped: false, outside: 0 }
    }

    /// A new estimate of the time `now_s`.
    pub fn look(&mut self, estimate: &Estimate, now_s: f64) {
        self.jumped = self.last.as_ref().is_some_and(|(then_s, last)| {
            let seconds = (now_s - then_s) as f32;
            let moved = distance(&estimate.position, &last.position);
            let speed = length(&estimate.velocity).max(length(&last.velocity));
            moved > speed * seconds * 1.5 + JUMP_M || distance(&estimate.velocity, &last.velocity) > JUMP_M_S
        });
        self.last = Some((now_s, *estimate));
    }

    /// What speaks against flying by `estimate`, which is so old.
    pub fn before(&self, estimate: &Estimate, age_s: f64) -> Option<Reason> {
        let l = &self.limits;
        let [x, _, z] = body_axes(estimate.attitude);
        let level = z[2].clamp(-1.0, 1.0).acos() < TILT_RAD;
        let ahead = (x[0] * l.heading[0] + x[1] * l.heading[1]).clamp(-1.0, 1.0).acos() < TILT_RAD;
        let inside = (0..3).all(|i| (l.volume[0][i]..=l.volume[1][i]).contains(&estimate.position[i]));
        let conditions = [
            (age_s > STALE_S, Reason::Stale),
            (self.jumped, Reason::Jump),
            (!inside, Reason::Fence),
            (estimate.voltage.is_nan(), Reason::NoVoltage),
            (estimate.voltage < l.empty_v, Reason::LowBattery),
            (distance(&estimate.position, &l.start) > START_M, Reason::NotAtStart),
            (length(&estimate.velocity) > REST_M_S, Reason::NotAtRest),
            (!level || !ahead, Reason::NotLevel),
        ];
        conditions.into_iter().find(|(holds, _)| *holds).map(|(_, reason)| reason)
    }

    /// Whether the policy has seen for too long what it was not trained for.
    pub fn after(&mut self, seen: &[f32; OBSERVATIONS], [low, high]: &[[f32; OBSERVATIONS]; 2]) -> Option<Reason> {
        let margin = |k: usize| OUTSIDE_MARGIN * (high[k] - low[k]);
        let inside = (0..OBSERVATIONS).all(|k| (low[k] - margin(k)..=high[k] + margin(k)).contains(&seen[k]));
        self.outside = if inside { 0 } else { self.outside + 1 };
        (self.outside > OUTSIDE_STEPS).then_some(Reason::OutsideRange)
    }
}

fn length(v: &[f32; 3]) -> f32 {
    v.iter().map(|x| x * x).sum::<f32>().sqrt()
}

fn distance(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    length(&std::array::from_fn(|i| a[i] - b[i]))
}
