//! Where an episode starts: on the pad, or somewhere along the track at speed.

use super::Race;
use crate::base::check::{Check, Invalid};
use crate::base::rng::Sequence;
use crate::model::dynamics::{Craft, Factors, State};
use nalgebra::{UnitQuaternion, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal, UnitCircle};
use serde::{Deserialize, Serialize};

/// Spread of the starting states (paper section 4.5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResetConfig {
    /// Share of episodes that start on the pad, at rest, as a race does; the others start along the spline.
    pub pad_share: f64,
    /// Share of failures after which the next episode starts along the spline on the way to the gate that was missed,
    /// or to the one before it. What is hard is then flown most.
    pub retry_share: f64,
    /// Speed along the spline, `[low, high]`, drawn evenly, m/s.
    pub speed_m_s: [f64; 2],
    /// Standard deviation of each coordinate about the spline, m.
    pub position_m: f64,
    /// Standard deviation of the direction of flight about the spline's, deg.
    pub direction_deg: f64,
    /// Half width of the even spread of roll and of pitch about level, deg.
    pub tilt_deg: f64,
    /// Half width of the even spread of the heading about the direction of flight, deg.
    pub yaw_deg: f64,
}

impl Check for ResetConfig {
    fn check(&self) -> Result<(), Invalid> {
        for (key, share) in [("pad_share", self.pad_share), ("retry_share", self.retry_share)] {
            Invalid::unless((0.0..=1.0).contains(&share), key, share, "a share, 0 to 1", "")?;
        }
        Invalid::unless_range("speed_m_s", self.speed_m_s, 0.0, "")?;
        Invalid::unless_not_negative("position_m", self.position_m, "")?;
        for (key, value) in
            [("direction_deg", self.direction_deg), ("tilt_deg", self.tilt_deg), ("yaw_deg", self.yaw_deg)]
        {
            Invalid::unless((0.0..=180.0).contains(&value), key, value, "0 to 180 degrees", "")?;
        }
        Ok(())
    }
}

/// How an episode begins.
#[derive(Clone, Debug)]
pub struct Start {
    pub craft: Craft<f64>,
    /// Index of the first target gate.
    pub target: usize,
}

/// Where an episode begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartPlace {
    /// At rest on the start pad, nothing perturbed.
    Pad,
    /// Somewhere along the lap's spline, perturbed.
    Spline,
    /// On the pad in the configured share of episodes, else along the spline.
    Mixed,
    /// Along the spline, perturbed, where this gate or the one before it comes next.
    Toward(usize),
}

/// Draws the start of an episode at `place`; the vehicle's parameters are `factors`, or drawn.
pub fn draw(race: &Race, rng: &mut Sequence, place: StartPlace, factors: Option<Factors>) -> Start {
    let config = &race.config;
    let nominal = factors.is_some();
    let mut factors = factors.unwrap_or_else(|| config.randomize.draw(rng));
    let voltage = if nominal {
        race.vehicle.battery.full_v
    } else {
        race.vehicle.battery.at(rng.uniform(config.randomize.charge))
    };
    let pad = match place {
        StartPlace::Pad => true,
        StartPlace::Spline | StartPlace::Toward(_) => false,
        StartPlace::Mixed => rng.random_bool(config.reset.pad_share),
    };
    let (state, target) = if pad {
        let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), race.start.heading_rad());
        (at_rest(race.start.position(), yaw, [0.0, 0.0, 0.0, -1.0], voltage), 0)
    } else {
        on_spline(race, rng, place, voltage)
    };
    if !nominal {
        // Last, so that vehicles with effects and without are given the same start.
        factors.effects = race.vehicle.effects.draw(rng);
    }
    Start { craft: Craft::new(&race.vehicle, &factors, race.dt, state), target }
}

fn on_spline(race: &Race, rng: &mut Sequence, place: StartPlace, voltage: f64) -> (State<f64>, usize) {
    let config = &race.config.reset;
    let point = match place {
        StartPlace::Toward(gate) => {
            let points = &race.approaches[gate];
            &race.lap[points.get(rng.random_range(0..points.len().max(1))).copied().unwrap_or(0)]
        }
        _ => &race.lap[rng.random_range(0..race.lap.len())],
    };
    let mut scatter = |sd: f64| Vector3::from_fn(|_, _| rng.sample::<f64, _>(StandardNormal)) * sd;
    let offset = scatter(config.position_m);
    let turned = UnitQuaternion::from_scaled_axis(scatter(config.direction_deg.to_radians())) * point.tangent;
    let speed = rng.uniform(config.speed_m_s);
    let yaw = point.tangent.y.atan2(point.tangent.x) + rng.uniform([-1.0, 1.0]) * config.yaw_deg.to_radians();
    let [x, y] = UnitCircle.sample(rng);
    let tilt = rng.uniform([0.0, config.tilt_deg.to_radians()]);
    let attitude = UnitQuaternion::from_scaled_axis(Vector3::new(x, y, 0.0) * tilt)
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);

    let gate = &race.gates[point.target];
    let [center, normal] = [gate.center, gate.axes[0]].map(|v| Vector3::from(v.map(f64::from)));
    let mut position = point.position + offset;
    // A start that the perturbation put just behind its gate is reflected to the side it has to come from.
    let along = (position - center).dot(&normal);
    if along > 0.0 && (position - center).norm() < REFLECT_WITHIN_M {
        position -= normal * (2.0 * along);
    }
    for i in 0..3 {
        // Half a metre inside the flight volume, so that no episode ends as it begins.
        position[i] = position[i].clamp(race.volume[0][i] + 0.5, race.volume[1][i] - 0.5);
    }
    let mut state = at_rest(position, attitude, [0.0, 0.0, 0.0, race.hover_command], voltage);
    state.velocity = (turned * speed).into();
    (state, point.target)
}

/// Starts nearer than this behind their gate are reflected, m.
const REFLECT_WITHIN_M: f64 = 2.0;

fn at_rest(position: Vector3<f64>, attitude: UnitQuaternion<f64>, command: [f64; 4], voltage: f64) -> State<f64> {
    State::new(position.into(), [0.0; 3], [attitude.w, attitude.i, attitude.j, attitude.k], command, voltage)
}
