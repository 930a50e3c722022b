//! The lap time with a logarithmic barrier before every limit, and its derivatives.
//!
//! Limits: thrust at every node, the aperture and the direction of crossing at every gate, the volume.

use super::course::{Course, Nodes, Place};
use super::jet::Jet;
use super::system::System;
use crate::base::lane::Real;
use crate::model::attitude::dot;
use nalgebra::{Matrix3, Vector3};

/// Variables of a node's motion: three positions and two durations.
const LOCAL: usize = 11;

/// A value with gradient and matrix of second derivatives.
pub struct Slopes {
    pub gradient: Vec<f64>,
    pub matrix: System,
}

impl Slopes {
    /// For laps with the nodes of `lap`.
    pub fn new(lap: &Nodes) -> Self {
        let (nodes, segments) = (lap.positions.len(), lap.steps.len());
        let (mut place, mut first) = (vec![0; 3 * nodes + segments], Vec::new());
        // Each duration stands behind the nodes of its segment, and knows them and the last one before them; a node
        // knows the two before it. The last two nodes and the last duration know the first nodes again: the border.
        let (mut node, mut at) = (0_usize, 0_usize);
        for (segment, &steps) in lap.steps.iter().enumerate() {
            let before = at;
            for _ in 0..steps {
                for c in 0..3 {
                    place[3 * node + c] = at;
                    let back = if node < 2 { 0 } else { place[3 * (node - 2)] };
                    first.push(back);
                    at += 1;
                }
                node += 1;
            }
            place[3 * nodes + segment] = at;
            first.push(before.saturating_sub(4));
            at += 1;
        }
        first.truncate(at - 7);
        Slopes { gradient: vec![0.0; 3 * nodes + segments], matrix: System::new(place, first) }
    }

    /// Adds `slope` and `curve` of variables at these places; nothing where a place is none.
    fn add<const N: usize>(&mut self, at: &[Option<usize>; N], slope: &[f64; N], curve: &[[f64; N]; N]) {
        for (i, row) in at.iter().enumerate().filter_map(|(i, row)| Some((i, (*row)?))) {
            self.gradient[row] += slope[i];
            for (j, column) in at.iter().enumerate().filter_map(|(j, column)| Some((j, (*column)?))) {
                self.matrix.add(row, column, curve[i][j]);
            }
        }
    }
}

/// Lap time plus `mu` times the barriers; infinite where a limit is not kept.
pub fn value(course: &Course, lap: &Nodes, mu: f64) -> f64 {
    if lap.seconds.iter().any(|&s| s.is_nan() || s <= 0.0) {
        return f64::INFINITY;
    }
    let mut sum = 0.0;
    // NaN counts as a limit that is not kept.
    let mut limit = |room: f64| sum -= if room > 0.0 { room.ln() } else { f64::NEG_INFINITY };
    for place in &lap.places() {
        let [a, v] = lap.motion(place);
        let f = Vector3::from(course.mass.thrust_for(a.into(), v.into()));
        limit(1.0 - f.norm_squared() / course.mass.thrust.powi(2));
        rooms(course, lap, place).into_iter().for_each(|(room, ..)| limit(room));
    }
    lap.total() + mu * sum
}

/// The room left to limits of position, in m or as a share of the aperture: with its derivatives by the position, and
/// which of the three nodes of the place it is about.
fn rooms(course: &Course, lap: &Nodes, place: &Place) -> Vec<(f64, usize, Vector3<f64>, f64)> {
    let mut rooms = Vec::with_capacity(9);
    let p = lap.positions[place.nodes[1]];
    for i in 0..3 {
        let axis = Vector3::ith(i, 1.0);
        rooms.push((p[i] - course.volume[0][i], 1, axis, 0.0));
        rooms.push((course.volume[1][i] - p[i], 1, -axis, 0.0));
    }
    if let Some(gate) = place.gate.map(|gate| &course.gates[gate]) {
        let normal: Vector3<f64> = gate.axes.column(0).into();
        let square = gate.radius * gate.radius;
        let offset = p - gate.centre;
        rooms.push((1.0 - offset.norm_squared() / square, 1, -2.0 * offset / square, -2.0 / square));
        rooms.push((normal.dot(&(gate.centre - lap.positions[place.nodes[0]])), 0, -normal, 0.0));
        rooms.push((normal.dot(&(lap.positions[place.nodes[2]] - gate.centre)), 2, normal, 0.0));
    }
    rooms
}

/// Gradient and second derivatives of [`value`]. Nodes at gates move in the gate's frame, and not along its first axis.
pub fn slopes(course: &Course, lap: &Nodes, mu: f64, out: &mut Slopes) {
    let nodes = lap.positions.len();
    out.gradient.fill(0.0);
    out.matrix.clear();
    out.gradient[3 * nodes..].fill(1.0);
    let places = lap.places();
    for place in &places {
        let frames = place.nodes.map(|i| frame(course, &places[i]));
        let at: [Option<usize>; LOCAL] = std::array::from_fn(|k| match k {
            0..9 => (places[place.nodes[k / 3]].gate.is_none() || k % 3 > 0).then(|| 3 * place.nodes[k / 3] + k % 3),
            _ => Some(3 * nodes + place.segments[k - 9]),
        });
        let (slope, curve) = thrust(course, lap, place, &frames, mu);
        out.add(&at, &slope, &curve);
        for (room, which, by, curved) in rooms(course, lap, place) {
            let (by, frame) = (frames[which].transpose() * by, 3 * which);
            let slope: [f64; 3] = (by * (-mu / room)).into();
            let curve: [[f64; 3]; 3] = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    mu * by[i] * by[j] / (room * room) - if i == j { mu * curved / room } else { 0.0 }
                })
            });
            out.add(&[at[frame], at[frame + 1], at[frame + 2]], &slope, &curve);
        }
        if place.gate.is_some() {
            out.matrix.add(3 * place.nodes[1], 3 * place.nodes[1], 1.0);
        }
    }
}

fn frame(course: &Course, place: &Place) -> Matrix3<f64> {
    place.gate.map_or(Matrix3::identity(), |gate| course.gates[gate].axes)
}

/// Gradient and second derivatives of the barrier before the thrust at `place`, by its local variables.
fn thrust(
    course: &Course,
    lap: &Nodes,
    place: &Place,
    frames: &[Matrix3<f64>; 3],
    mu: f64,
) -> ([f64; LOCAL], [[f64; LOCAL]; LOCAL]) {
    let [a, v] = lap.motion(place);
    let variable = |k: usize| Jet::<6>::variable(if k < 3 { a[k] } else { v[k - 3] }, k);
    let f = course.mass.thrust_for(std::array::from_fn(variable), std::array::from_fn(|k| variable(k + 3)));
    let room = Jet::of(1.0) - dot(f, f) * Jet::of(course.mass.thrust.powi(-2));
    let barrier = -room.ln() * Jet::of(mu);

    // Acceleration and velocity are sums of the three positions with weights that depend on the durations.
    let [n1, n2] = place.segments.map(|segment| Jet::<2>::of(lap.steps[segment] as f64));
    let [t1, t2] = place.segments.map(|segment| lap.seconds[segment]);
    let (h1, h2) = (Jet::<2>::variable(t1, 0) / n1, Jet::<2>::variable(t2, 1) / n2);
    let span = h1 + h2;
    let weights = |before: Jet<2>, after: Jet<2>| [before, -(before + after), after];
    let two = Jet::of(2.0);
    let kinds = [weights(two / (h1 * span), two / (h2 * span)), weights(-(h2 / (h1 * span)), h1 / (h2 * span))];

    let points = place.nodes.map(|i| lap.positions[i]);
    let mut by = [[0.0; LOCAL]; 6];
    let mut curve = [[0.0; LOCAL]; LOCAL];
    for (o, by) in by.iter_mut().enumerate() {
        let (weights, axis, pull) = (&kinds[o / 3], o % 3, barrier.slope[o]);
        for (n, weight) in weights.iter().enumerate() {
            for c in 0..3 {
                let part = frames[n][(axis, c)];
                by[3 * n + c] = weight.value * part;
                for k in 0..2 {
                    curve[3 * n + c][9 + k] += pull * weight.slope[k] * part;
                    curve[9 + k][3 * n + c] += pull * weight.slope[k] * part;
                }
            }
            for k in 0..2 {
                by[9 + k] += weight.slope[k] * points[n][axis];
                for l in 0..2 {
                    curve[9 + k][9 + l] += pull * weight.curve[k][l] * points[n][axis];
                }
            }
        }
    }
    let mut slope = [0.0; LOCAL];
    for o in 0..6 {
        let mut row = [0.0; LOCAL];
        for (q, by) in by.iter().enumerate() {
            row.iter_mut().zip(by).for_each(|(r, b)| *r += barrier.curve[o][q] * b);
        }
        for i in 0..LOCAL {
            slope[i] += barrier.slope[o] * by[o][i];
            for j in 0..LOCAL {
                curve[i][j] += by[o][i] * row[j];
            }
        }
    }
    (slope, curve)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the gates are twice the numbers, whatever their steps: work grows no faster than the lap does.
    #[test]
    fn the_equations_grow_with_the_lap() {
        let entries = |gates: usize| {
            let steps: Vec<usize> = (0..gates).map(|g| 20 + 7 * (g % 4)).collect();
            let nodes = steps.iter().sum();
            let lap = Nodes { positions: vec![Vector3::zeros(); nodes], seconds: vec![1.0; gates], steps };
            Slopes::new(&lap).matrix.entries() as f64
        };
        for gates in [4, 40] {
            let growth = entries(2 * gates) / entries(gates);
            assert!((1.9..2.1).contains(&growth), "{growth}");
        }
    }
}
