//! A closed curve through points, by arc length: where episodes start, and how far along a vehicle is.

use nalgebra::Vector3;

/// Pieces that each segment is measured in. Lengths are then right to a few parts in a million.
const PIECES: usize = 256;

/// A cyclic Catmull-Rom spline with uniform knots.
///
/// Knots are uniform because the tangent at a point is then parallel to the chord between its neighbours, however short
/// the way to one of them is. Where two gates stand on top of each other (split-S, ladder) this leaves the upper gate
/// in its direction of crossing and enters the lower one in its own: within 27 degrees at the split-S of A2RL Season 2,
/// where centripetal knots, which follow the short chord straight down, are off by 45. Loops, which uniform knots can
/// make, need a detour that comes back to where it left; no shipped track has one.
#[derive(Clone, Debug)]
pub struct Spline {
    segments: Vec<CubicSegment>,
    /// Arc length at the start of each piece, and the total at the end, m.
    lengths: Vec<f64>,
}

/// A place on a spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub position: Vector3<f64>,
    /// Direction of increasing arc length, unit length.
    pub tangent: Vector3<f64>,
    /// Arc length from the first point, m.
    pub arc_length: f64,
    /// Index of the first control point ahead; at a control point, the one after it.
    pub next: usize,
}

impl Spline {
    /// The closed curve through `points` in order, and back to the first.
    ///
    /// # Panics
    ///
    /// With fewer than two points. A track has at least two gates.
    pub fn through(points: &[Vector3<f64>]) -> Self {
        let count = points.len();
        assert!(count >= 2, "a closed curve needs two points");
        let point = |index: usize| points[index % count];
        let segments =
            (0..count).map(|i| CubicSegment::new(point(i + count - 1), point(i), point(i + 1), point(i + 2)));
        let segments: Vec<_> = segments.collect();
        let mut lengths = vec![0.0];
        let mut total = 0.0;
        for segment in &segments {
            for piece in 0..PIECES {
                total += segment.length(piece as f64 / PIECES as f64, 1.0 / PIECES as f64);
                lengths.push(total);
            }
        }
        Self { segments, lengths }
    }

    /// Length of the whole curve, m.
    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Arc length at control point `index`, m.
    pub fn length_at(&self, index: usize) -> f64 {
        self.lengths[index % self.segments.len() * PIECES]
    }

    /// Position at arc length `s`, m; any `s`, the curve is closed.
    pub fn position(&self, s: f64) -> Vector3<f64> {
        let (segment, t) = self.locate(s);
        self.segments[segment].position(t)
    }

    /// Unit tangent at arc length `s`; any `s`.
    pub fn tangent(&self, s: f64) -> Vector3<f64> {
        let (segment, t) = self.locate(s);
        self.segments[segment].tangent(t)
    }

    /// Curvature at arc length `s`, 1/m; any `s`. At a control point that of the segment after it: the curve has no
    /// kinks there, but its curvature jumps.
    pub fn curvature(&self, s: f64) -> f64 {
        let (segment, t) = self.locate(s);
        self.segments[segment].curvature(t)
    }

    /// The place at arc length `s`; any `s`.
    pub fn sample(&self, s: f64) -> Sample {
        let (segment, t) = self.locate(s);
        Sample {
            position: self.segments[segment].position(t),
            tangent: self.segments[segment].tangent(t),
            arc_length: s.rem_euclid(self.length()),
            next: (segment + 1) % self.segments.len(),
        }
    }

    /// `count` places at equal distances, beginning at the first point.
    pub fn samples(&self, count: usize) -> Vec<Sample> {
        (0..count).map(|i| self.sample(self.length() * i as f64 / count as f64)).collect()
    }

    /// Segment and parameter within it, 0 to 1.
    fn locate(&self, s: f64) -> (usize, f64) {
        let s = s.rem_euclid(self.length());
        let last = self.lengths.len() - 2;
        let piece = (self.lengths.partition_point(|&length| length <= s).max(1) - 1).min(last);
        let (from, to) = (self.lengths[piece], self.lengths[piece + 1]);
        let part = if to > from { (s - from) / (to - from) } else { 0.0 };
        let (segment, start, step) = (piece / PIECES, (piece % PIECES) as f64 / PIECES as f64, part / PIECES as f64);
        // Speed varies within the piece: one step of Newton's method takes out what the straight guess leaves.
        let (cubic, guess) = (&self.segments[segment], start + step);
        let correction = (s - from - cubic.length(start, step)) / cubic.derivative(guess).norm();
        let t = if correction.is_finite() { guess + correction } else { guess };
        (segment, t.clamp(0.0, 1.0))
    }
}

/// A cubic `a + b t + c t^2 + d t^3`, t from 0 to 1.
#[derive(Clone, Copy, Debug)]
struct CubicSegment([Vector3<f64>; 4]);

impl CubicSegment {
    /// From `p1` to `p2`, with the neighbours before and after.
    fn new(p0: Vector3<f64>, p1: Vector3<f64>, p2: Vector3<f64>, p3: Vector3<f64>) -> Self {
        let (m1, m2) = ((p2 - p0) / 2.0, (p3 - p1) / 2.0);
        Self([p1, m1, 3.0 * (p2 - p1) - 2.0 * m1 - m2, 2.0 * (p1 - p2) + m1 + m2])
    }

    fn position(&self, t: f64) -> Vector3<f64> {
        let [a, b, c, d] = self.0;
        a + (b + (c + d * t) * t) * t
    }

    fn derivative(&self, t: f64) -> Vector3<f64> {
        let [_, b, c, d] = self.0;
        b + (2.0 * c + 3.0 * d * t) * t
    }

    /// 0 where the curve stands still.
    fn curvature(&self, t: f64) -> f64 {
        let [_, _, c, d] = self.0;
        let (first, second) = (self.derivative(t), 2.0 * c + 6.0 * d * t);
        let curvature = first.cross(&second).norm() / first.norm().powi(3);
        if curvature.is_finite() { curvature } else { 0.0 }
    }

    /// Where the curve stands still, as it does at the ends of a line flown there and back, the chord's direction.
    fn tangent(&self, t: f64) -> Vector3<f64> {
        let chord = self.position(1.0) - self.position(0.0);
        self.derivative(t).try_normalize(1e-9).or_else(|| chord.try_normalize(0.0)).unwrap_or_else(Vector3::x)
    }

    /// Length between `t` and `t + step`, by Simpson's rule.
    fn length(&self, t: f64, step: f64) -> f64 {
        let speed = |t: f64| self.derivative(t).norm();
        step / 6.0 * (speed(t) + 4.0 * speed(t + step / 2.0) + speed(t + step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Points of two heights around a bent loop, unevenly spaced.
    fn bent() -> Vec<Vector3<f64>> {
        [[0.0, 0.0, 1.0], [6.0, 1.0, 1.0], [9.0, 7.0, 4.0], [9.0, 7.0, 1.0], [2.0, 8.0, 2.0]].map(Vector3::from).into()
    }

    #[test]
    fn passes_through_its_points_in_order() {
        let (points, spline) = (bent(), Spline::through(&bent()));
        for (index, point) in points.iter().enumerate() {
            let s = spline.length_at(index);
            assert!((spline.position(s) - point).norm() < 1e-9);
            assert_eq!(spline.sample(s + 1e-6).next, (index + 1) % points.len());
            assert_eq!(spline.sample(s - 1e-6).next, index);
        }
    }

    #[test]
    fn the_tangent_is_the_derivative_by_arc_length() {
        let spline = Spline::through(&bent());
        for sample in spline.samples(97) {
            let h = 1e-4;
            let slope = (spline.position(sample.arc_length + h) - spline.position(sample.arc_length - h)) / (2.0 * h);
            assert!((slope - sample.tangent).norm() < 1e-3, "at {}: {}", sample.arc_length, slope - sample.tangent);
            assert!((sample.tangent.norm() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn is_closed() {
        let spline = Spline::through(&bent());
        let length = spline.length();
        assert!((spline.position(length - 1e-9) - spline.position(0.0)).norm() < 1e-6);
        assert!((spline.tangent(length - 1e-9) - spline.tangent(0.0)).norm() < 1e-6);
        assert!((spline.position(-1.5) - spline.position(length - 1.5)).norm() < 1e-9);
        assert!((spline.position(2.0 * length + 3.0) - spline.position(3.0)).norm() < 1e-9);
    }

    /// A Catmull-Rom spline misses a circle by the fourth power of the angle between points: 64 points, one part in
    /// 10^6.
    #[test]
    fn the_length_of_a_circle_of_points() {
        let angle = |i: u32| f64::from(i) / 64.0 * TAU;
        let points: Vec<_> = (0..64).map(|i| Vector3::new(5.0 * angle(i).cos(), 5.0 * angle(i).sin(), 2.0)).collect();
        let spline = Spline::through(&points);
        assert!((spline.length() / (5.0 * TAU) - 1.0).abs() < 1e-5);
        assert!(spline.samples(200).iter().all(|s| (5.0 * spline.curvature(s.arc_length) - 1.0).abs() < 0.01));
    }

    #[test]
    fn two_points_make_a_line_there_and_back() {
        let spline = Spline::through(&[Vector3::zeros(), Vector3::new(4.0, 0.0, 0.0)]);
        assert!((spline.length() - 8.0).abs() < 1e-9);
        assert!(spline.samples(16).iter().all(|sample| (sample.tangent.norm() - 1.0).abs() < 1e-12));
    }
}
