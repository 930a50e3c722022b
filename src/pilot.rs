//! A pilot who flies what identification needs: sharp steps on every stick, the whole throttle range, fast passes in every
//! direction, climbs and descents, again and again while the battery empties.
//!
//! Short manoeuvres follow each other at random; between them, and whenever the box or the ground comes near, the pilot
//! recovers to its middle.

mod manoeuvre;
mod stabilise;

use crate::rng::{Philox, Sequence, Stream};
pub use manoeuvre::Kind;
use manoeuvre::Manoeuvre;
use stabilise::Stabiliser;

/// What the pilot sees of the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Since the start, s.
    pub time_s: f64,
    /// World, m and m/s.
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    /// Body to world, w x y z.
    pub attitude: [f64; 4],
}

/// What the pilot knows of the vehicle beforehand, roughly.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Roll, pitch, yaw rate at full stick, rad/s.
    pub max_rate_rad_s: [f64; 3],
    /// Thrust command that carries it, -1..1.
    pub hover: f64,
    /// Thrust at full command over weight.
    pub thrust_to_weight: f64,
}

/// Time on the ground before take-off, s.
pub const GROUND_S: f64 = 2.0;
/// The middle of the box, m.
const MIDDLE: [f64; 3] = [0.0, 0.0, 35.0];
/// Beyond these the pilot breaks off: distance from the middle in the plane, lowest and highest height, m.
const WIDE: f64 = 70.0;
const LOW: f64 = 14.0;
const HIGH: f64 = 65.0;
/// A manoeuvre begins when slower than this and more upright than this (cosine of the tilt).
const CALM_M_S: f64 = 3.0;
const CALM_UPRIGHT: f64 = 0.93;

/// The pilot; ask it for a command 100 times a second.
#[derive(Clone, Debug)]
pub struct Pilot {
    rng: Sequence,
    stabiliser: Stabiliser,
    known: Known,
    kinds: Vec<Kind>,
    next: usize,
    flying: Option<Manoeuvre>,
}

impl Pilot {
    /// A pilot who flies all kinds of manoeuvres in turn.
    pub fn new(seed: u64, known: Known) -> Self {
        Self::of(seed, known, &Kind::ALL)
    }

    /// A pilot who flies these kinds in turn.
    ///
    /// # Panics
    /// If there are none.
    pub fn of(seed: u64, known: Known, kinds: &[Kind]) -> Self {
        assert!(!kinds.is_empty(), "a pilot needs something to fly");
        let rng = Philox::new(seed).sequence(Stream::Pilot, 0, 0);
        Self { rng, stabiliser: Stabiliser::new(known), known, kinds: kinds.into(), next: 0, flying: None }
    }

    /// Roll, pitch, yaw rate and thrust, each in [-1, 1].
    pub fn command(&mut self, seen: &Seen) -> [f64; 4] {
        if seen.time_s < GROUND_S {
            return [0.0, 0.0, 0.0, -1.0];
        }
        if self.in_danger(seen) {
            self.flying = None;
        }
        if self.flying.as_ref().is_some_and(|manoeuvre| seen.time_s >= manoeuvre.until_s) {
            self.flying = None;
        }
        if self.flying.is_none() && self.calm(seen) {
            let kind = self.kinds[self.next % self.kinds.len()];
            self.next += 1;
            self.flying = Some(Manoeuvre::begin(kind, seen, &self.known, &mut self.rng));
        }
        let command = match &mut self.flying {
            Some(manoeuvre) => manoeuvre.command(seen, &mut self.stabiliser, &mut self.rng),
            None => self.recover(seen),
        };
        command.map(|x| x.clamp(-1.0, 1.0))
    }

    fn recover(&mut self, seen: &Seen) -> [f64; 4] {
        let to: [f64; 3] = std::array::from_fn(|k| 0.8 * (MIDDLE[k] - seen.position[k]));
        let speed = to[0].hypot(to[1]).max(1e-9);
        let slower = (12.0 / speed).min(1.0);
        self.stabiliser.velocity(seen, [to[0] * slower, to[1] * slower, to[2].clamp(-6.0, 8.0)], None)
    }

    fn calm(&self, seen: &Seen) -> bool {
        let speed = seen.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        let inside =
            seen.position[0].hypot(seen.position[1]) < 0.5 * WIDE && (seen.position[2] - MIDDLE[2]).abs() < 8.0;
        speed < CALM_M_S && stabilise::upright(seen) > CALM_UPRIGHT && inside
    }

    /// Whether the vehicle would leave the box if it went on for the time that a turn to safety takes.
    fn in_danger(&self, seen: &Seen) -> bool {
        let ahead = |k: usize, seconds: f64| seen.position[k] + seconds * seen.velocity[k];
        let [x, y] = [ahead(0, 1.0), ahead(1, 1.0)];
        // Turning upright, then braking with what thrust is left over the weight.
        let brake = 0.6 * 9.81 * (self.known.thrust_to_weight - 1.0);
        let fall = (-seen.velocity[2]).max(0.0);
        let low = ahead(2, 0.7) - fall * fall / (2.0 * brake);
        let climb = seen.velocity[2].max(0.0);
        let high = ahead(2, 0.3) + climb * climb / (2.0 * 9.0);
        x.hypot(y) > WIDE || low < LOW || high > HIGH
    }
}
