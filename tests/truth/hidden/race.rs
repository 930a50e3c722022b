//! Who flies a race: along a curve through the gates, as fast as the turns allow, without a move for the log's sake.

use crate::truth::Vehicle;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use racer::flight::pilot::Seen;
use racer::model::track::Track;
use racer::model::track::spline::Spline;

const TRACKS: [&str; 4] = ["a2rl_s2", "a2rl_s1", "uzh_split_s", "figure_eight"];
/// Places that the curve is looked at.
const PLACES: usize = 600;
/// Share of the thrust that is not needed to stay up, to be used in turns and for changes of speed.
const TURNING: f64 = 0.55;
const CHANGING: f64 = 0.3;
const FASTEST: f64 = 18.0;
const SLOWEST: f64 = 3.0;
/// Lowest height aimed at, m.
const LOWEST: f64 = 1.2;
/// How far ahead the command looks, s: what vehicle and lag need to answer.
const AHEAD_S: f64 = 0.12;
/// Error of place to velocity, of velocity to acceleration, of attitude and heading to rate, 1/s.
const PLACE: f64 = 1.8;
const VELOCITY: f64 = 3.5;
const ATTITUDE: f64 = 9.0;
const HEADING: f64 = 2.5;
/// Learning of a standing acceleration, 1/s2, and its limit, m/s2.
const STANDING: [f64; 2] = [1.2, 6.0];
/// Time on the pad, s.
const WAIT_S: f64 = 1.5;

/// See the module.
pub struct Racer {
    vehicle: Vehicle,
    line: Spline,
    /// Speed at each place, m/s.
    speeds: Vec<f64>,
    /// From the world to the track: where the pad is.
    pad: Vector3<f64>,
    /// How far along, m.
    along: f64,
    standing: Vector3<f64>,
}

impl Racer {
    pub fn new(vehicle: &Vehicle, seed: u64) -> Self {
        let track = Track::load(TRACKS[(seed % TRACKS.len() as u64) as usize]).expect("built in");
        let pad = track.start.position();
        let line = Spline::through(&track.centres());
        let spare = vehicle.thrust_at_full() - vehicle.gravity;
        let speeds = profile(&line, TURNING * spare, CHANGING * spare);
        let pad = Vector3::new(pad.x, pad.y, 0.0);
        Racer { vehicle: vehicle.clone(), line, speeds, pad, along: 0.0, standing: Vector3::zeros() }
    }

    /// The command for the next 10 ms: roll, pitch, yaw rate and thrust, each in [-1, 1].
    pub fn command(&mut self, seen: &Seen) -> [f64; 4] {
        if seen.time_s < WAIT_S {
            return [0.0, 0.0, 0.0, -1.0];
        }
        let (place, velocity) = (Vector3::from(seen.position) + self.pad, Vector3::from(seen.velocity));
        self.advance(&place);
        let (goal, speed) = (self.along + AHEAD_S * velocity.norm(), velocity.norm());
        let mut off = self.line.position(self.along) - place;
        off.z = self.line.position(self.along).z.max(LOWEST) - place.z;
        let tangent = self.line.tangent(goal);
        let wanted = tangent * self.speed(goal) + (off * PLACE).cap_magnitude(6.0);
        let error = (wanted - velocity).cap_magnitude(5.0);
        self.standing = (self.standing + error * (STANDING[0] * 0.01)).cap_magnitude(STANDING[1]);
        let turning = (self.line.tangent(goal + 0.5) - self.line.tangent(goal - 0.5)) * speed * speed;
        let turning = turning.cap_magnitude(TURNING * (self.vehicle.thrust_at_full() - self.vehicle.gravity));
        let force = turning + error * VELOCITY + self.standing + Vector3::new(0.0, 0.0, self.vehicle.gravity);
        self.fly(seen, force, &tangent)
    }

    /// Attitude and thrust for the specific force `force`, world.
    fn fly(&self, seen: &Seen, mut force: Vector3<f64>, tangent: &Vector3<f64>) -> [f64; 4] {
        // A racer leans over, but never pulls itself down.
        force.z = force.z.max(0.2 * self.vehicle.gravity);
        let force = force.cap_magnitude(0.95 * self.vehicle.thrust_at_full());
        let [w, x, y, z] = seen.attitude;
        let attitude = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let there = attitude.inverse() * force.normalize();
        let angle = there.z.clamp(-1.0, 1.0).acos();
        let axis = Vector3::new(-there.y, there.x, 0.0).try_normalize(1e-9).unwrap_or_else(Vector3::zeros);
        let ahead = attitude.inverse() * tangent;
        let yaw = if ahead.xy().norm() > 0.2 { ahead.y.atan2(ahead.x) } else { 0.0 };
        let rates = axis * (angle * ATTITUDE) + Vector3::new(0.0, 0.0, yaw * HEADING);
        let stick = rates.component_div(&Vector3::from(self.vehicle.configured_rate)).map(|x| x.clamp(-1.0, 1.0));
        let lift = force.dot(&(attitude * Vector3::z())).max(0.0);
        let thrust = self.vehicle.command_for(lift, seen.voltage.max(self.vehicle.empty_v));
        [stick.x, stick.y, stick.z, thrust.clamp(-1.0, 1.0)]
    }

    /// Goes on to the place of the line that is nearest, never back.
    fn advance(&mut self, place: &Vector3<f64>) {
        let away = |s: f64| (self.line.position(s) - place).norm();
        let nearest = (0..40).map(|k| self.along + 0.1 * f64::from(k));
        self.along = nearest.min_by(|a, b| away(*a).total_cmp(&away(*b))).unwrap_or(self.along);
    }

    fn speed(&self, s: f64) -> f64 {
        let share = s.rem_euclid(self.line.length()) / self.line.length();
        self.speeds[(share * PLACES as f64) as usize % PLACES]
    }
}

/// The speed at each place that `turning` (m/s2) across and `changing` along allow.
fn profile(line: &Spline, turning: f64, changing: f64) -> Vec<f64> {
    let step = line.length() / PLACES as f64;
    let curvature = |i: usize| {
        let s = i as f64 * step;
        (line.tangent(s + 0.5) - line.tangent(s - 0.5)).norm().max(1e-3)
    };
    let mut speeds: Vec<f64> = (0..PLACES).map(|i| (turning / curvature(i)).sqrt().clamp(SLOWEST, FASTEST)).collect();
    // Twice around, so that the end knows the beginning.
    for i in (0..2 * PLACES).rev() {
        let after: f64 = speeds[(i + 1) % PLACES];
        speeds[i % PLACES] = speeds[i % PLACES].min((after * after + 2.0 * changing * step).sqrt());
    }
    for i in 0..2 * PLACES {
        let before: f64 = speeds[i % PLACES];
        let next = (i + 1) % PLACES;
        speeds[next] = speeds[next].min((before * before + 2.0 * changing * step).sqrt());
    }
    speeds
}
