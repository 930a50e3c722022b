//! What is to be flown, and a lap of it as numbers: places at equal times between gates.

use super::mass::Mass;
use crate::base::rng::Sequence;
use crate::model::track::Track;
use nalgebra::{Matrix3, Vector3};
use rand::RngExt;
use rand_distr::StandardNormal;

/// A cyclic course of apertures in a volume.
#[derive(Clone, Debug)]
pub struct Course {
    pub mass: Mass,
    pub gates: Vec<Aperture>,
    /// Lower and upper corner, m.
    pub volume: [[f64; 3]; 2],
}

/// A round hole, to be crossed along the first column of `axes`.
#[derive(Clone, Debug)]
pub struct Aperture {
    pub centre: Vector3<f64>,
    pub axes: Matrix3<f64>,
    /// m
    pub radius: f64,
}

/// A closed lap. Node `first[g]` lies in the plane of gate `g`.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// m, world.
    pub positions: Vec<Vector3<f64>>,
    /// Steps from each gate to the next, and how long they take together, s.
    pub steps: Vec<usize>,
    pub seconds: Vec<f64>,
}

/// Nodes start so far inside of walls and rims, as a share of the way to the middle.
const INSIDE: f64 = 0.02;
/// Least steps between gates.
pub const LEAST_STEPS: usize = 6;

impl Course {
    pub fn new(track: &Track, mass: Mass) -> Self {
        let gates = track.gates.iter();
        let gates =
            gates.map(|gate| Aperture { centre: gate.position(), axes: gate.rotation(), radius: gate.radius_m });
        Course { mass, gates: gates.collect(), volume: [track.volume.min_m, track.volume.max_m] }
    }

    /// A slow lap along cubics that cross each gate at right angles, with about `density` steps to a gate; `disorder`
    /// above 0 bends them at random. None where a gate cannot be reached.
    pub fn guess(&self, density: usize, disorder: f64, rng: &mut Sequence) -> Option<Nodes> {
        let count = self.gates.len();
        let crossings: Option<Vec<_>> = self.gates.iter().map(|gate| self.crossing(gate)).collect();
        let crossings = crossings?;
        let chord = |g: usize| (crossings[(g + 1) % count] - crossings[g]).norm();
        let tangents: Vec<_> = (0..count)
            .map(|g| {
                let size = 0.5 * (chord(g) + chord((g + count - 1) % count)).max(0.5);
                let mut bend = || disorder * rng.sample::<f64, _>(StandardNormal);
                let normal = self.gates[g].axes * Vector3::new(1.0, bend(), bend());
                normal * size * (bend() + 0.3 * disorder).exp()
            })
            .collect();
        let mean = (0..count).map(chord).sum::<f64>() / count as f64;
        let steps: Vec<usize> = (0..count)
            .map(|g| ((0.5 + 0.5 * chord(g) / mean) * density as f64).round() as usize)
            .map(|steps| steps.max(LEAST_STEPS))
            .collect();
        let mut positions = Vec::new();
        for g in 0..count {
            let next = (g + 1) % count;
            for step in 0..steps[g] {
                let t = step as f64 / steps[g] as f64;
                let p = hermite(t, crossings[g], tangents[g], crossings[next], tangents[next]);
                positions.push(if step == 0 { p } else { self.inside(p) });
            }
        }
        Some(Nodes { positions, steps, seconds: (0..count).map(|g| 0.1 * chord(g).max(1.0)).collect() })
    }

    /// A place in the aperture and the volume, near the middle of the aperture.
    fn crossing(&self, gate: &Aperture) -> Option<Vector3<f64>> {
        let mut local = gate.axes.transpose() * (self.inside(gate.centre) - gate.centre);
        local.x = 0.0;
        let place = gate.centre + gate.axes * local;
        let open = (0..3).all(|i| self.volume[0][i] < place[i] && place[i] < self.volume[1][i]);
        (local.norm() < gate.radius && open).then_some(place)
    }

    /// The nearest place a little inside the volume.
    fn inside(&self, p: Vector3<f64>) -> Vector3<f64> {
        let [low, high] = self.volume;
        Vector3::from_fn(|i, _| {
            let margin = INSIDE * (high[i] - low[i]);
            p[i].clamp(low[i] + margin, high[i] - margin)
        })
    }
}

fn hermite(t: f64, a: Vector3<f64>, from: Vector3<f64>, b: Vector3<f64>, to: Vector3<f64>) -> Vector3<f64> {
    let (t2, t3) = (t * t, t * t * t);
    a * (2.0 * t3 - 3.0 * t2 + 1.0) + from * (t3 - 2.0 * t2 + t) + b * (3.0 * t2 - 2.0 * t3) + to * (t3 - t2)
}

/// A node with its neighbours, and the segments that the steps to it and from it belong to.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub nodes: [usize; 3],
    pub segments: [usize; 2],
    /// The gate whose plane it lies in.
    pub gate: Option<usize>,
}

impl Nodes {
    /// Time of a lap, s.
    pub fn total(&self) -> f64 {
        self.seconds.iter().sum()
    }

    /// Length of each segment's step, s.
    pub fn step(&self, segment: usize) -> f64 {
        self.seconds[segment] / self.steps[segment] as f64
    }

    /// All nodes in order, from the first gate's on.
    pub fn places(&self) -> Vec<Place> {
        let (count, segments) = (self.positions.len(), self.steps.len());
        let mut places = Vec::with_capacity(count);
        for (segment, &steps) in self.steps.iter().enumerate() {
            for step in 0..steps {
                let i = places.len();
                let before = if step == 0 { (segment + segments - 1) % segments } else { segment };
                places.push(Place {
                    nodes: [(i + count - 1) % count, i, (i + 1) % count],
                    segments: [before, segment],
                    gate: (step == 0).then_some(segment),
                });
            }
        }
        places
    }

    /// Acceleration (m/s2) and velocity (m/s) at a node, from its distances to the neighbours.
    pub fn motion(&self, place: &Place) -> [Vector3<f64>; 2] {
        let [before, here, after] = place.nodes.map(|i| self.positions[i]);
        let [h1, h2] = place.segments.map(|segment| self.step(segment));
        let (d1, d2) = ((here - before) / h1, (after - here) / h2);
        [2.0 * (d2 - d1) / (h1 + h2), (h2 * d1 + h1 * d2) / (h1 + h2)]
    }

    /// The same lap at about `density` steps to a gate, of equal length throughout.
    pub fn refined(&self, density: usize) -> Nodes {
        let places = self.places();
        let step = self.total() / (density * self.steps.len()) as f64;
        let steps: Vec<usize> = self.seconds.iter().map(|s| ((s / step).round() as usize).max(LEAST_STEPS)).collect();
        let mut positions = Vec::new();
        let mut first = 0;
        for (segment, &count) in steps.iter().enumerate() {
            for k in 0..count {
                let at = k as f64 * self.steps[segment] as f64 / count as f64;
                let place = &places[first + at as usize];
                let next = &places[place.nodes[2]];
                let h = self.step(segment);
                let [from, to] = [place, next].map(|p| self.motion(p)[1] * h);
                let [a, b] = [place, next].map(|p| self.positions[p.nodes[1]]);
                positions.push(hermite(at.fract(), a, from, b, to));
            }
            first += self.steps[segment];
        }
        Nodes { positions, steps, seconds: self.seconds.clone() }
    }
}
