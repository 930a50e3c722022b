//! A gate: a round aperture in a plane, to be crossed in one direction.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// One gate of a track.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gate {
    /// Centre of the aperture in the world, m.
    pub position_m: [f64; 3],
    /// Direction of crossing, counter-clockwise from east, deg.
    pub heading_deg: f64,
    /// Direction of crossing above the horizontal, deg.
    #[serde(default)]
    pub pitch_deg: f64,
    /// Radius of the aperture, m.
    pub radius_m: f64,
    /// Whether it stands there.
    pub kind: GateKind,
    /// Side of the square frame around it, for drawing only, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer_m: Option<f64>,
}

/// Whether there is anything to hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GateKind {
    /// A frame.
    Physical,
    /// A place to pass that the route alone does not enforce. Scored as a gate, but no obstacle.
    Virtual,
}

impl Gate {
    /// Centre, m.
    pub fn position(&self) -> Vector3<f64> {
        self.position_m.into()
    }

    /// From the gate's frame to the world: the columns are the direction of crossing (x), left (y) and up (z).
    pub fn rotation(&self) -> Matrix3<f64> {
        let (sin_h, cos_h) = sin_cos_deg(self.heading_deg);
        let (sin_p, cos_p) = sin_cos_deg(self.pitch_deg);
        Matrix3::from_columns(&[
            Vector3::new(cos_p * cos_h, cos_p * sin_h, sin_p),
            Vector3::new(-sin_h, cos_h, 0.0),
            Vector3::new(-sin_p * cos_h, -sin_p * sin_h, cos_p),
        ])
    }

    /// Half the size of the box around the aperture disk, m.
    pub fn reach(&self) -> Vector3<f64> {
        let normal: Vector3<f64> = self.rotation().column(0).into();
        normal.map(|n| self.radius_m * (1.0 - n * n).max(0.0).sqrt())
    }
}

/// Exact at multiples of 90 degrees, where most gates stand.
fn sin_cos_deg(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate(heading_deg: f64, pitch_deg: f64) -> Gate {
        let position_m = [0.0; 3];
        Gate { position_m, heading_deg, pitch_deg, radius_m: 0.75, kind: GateKind::Physical, outer_m: None }
    }

    #[test]
    fn the_frame_is_right_handed_and_orthonormal() {
        for (heading, pitch) in [(0.0, 0.0), (37.0, 20.0), (180.0, -90.0), (-135.0, 45.0)] {
            let rotation = gate(heading, pitch).rotation();
            assert!((rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-12);
            assert!((rotation.determinant() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn heading_is_counter_clockwise_and_pitch_is_upwards() {
        assert_eq!(gate(90.0, 0.0).rotation() * Vector3::x(), Vector3::y());
        assert_eq!(gate(0.0, 0.0).rotation() * Vector3::y(), Vector3::y());
        assert_eq!(gate(0.0, 90.0).rotation() * Vector3::x(), Vector3::z());
    }

    #[test]
    fn a_vertical_gate_reaches_up_and_sideways_only() {
        assert!((gate(0.0, 0.0).reach() - Vector3::new(0.0, 0.75, 0.75)).norm() < 1e-12);
        assert!((gate(0.0, 90.0).reach() - Vector3::new(0.75, 0.75, 0.0)).norm() < 1e-12);
    }
}
