//! Frames: body front-left-up and world east-north-up from what a file uses.

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};
use serde::Deserialize;
use std::f64::consts::FRAC_1_SQRT_2;

/// Axes of the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Body {
    /// Front, left, up.
    #[default]
    #[serde(rename = "FLU")]
    Flu,
    /// Front, right, down.
    #[serde(rename = "FRD")]
    Frd,
}

/// Axes of the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum World {
    /// East, north, up.
    #[default]
    #[serde(rename = "ENU")]
    Enu,
    /// North, east, down.
    #[serde(rename = "NED")]
    Ned,
}

/// Axes in which a file gives the velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VelocityFrame {
    #[default]
    Body,
    World,
}

impl Body {
    /// A vector in these axes, front-left-up.
    pub fn to_flu(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Body::Flu => [x, y, z],
            Body::Frd => [x, -y, -z],
        }
    }
}

impl World {
    /// A vector in these axes, east-north-up.
    pub fn to_enu(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            World::Enu => [x, y, z],
            World::Ned => [y, x, -z],
        }
    }
}

/// The attitude front-left-up to east-north-up from one between other axes; (w, x, y, z), its length as it was.
pub fn attitude(q: [f64; 4], body: Body, world: World) -> [f64; 4] {
    let [w, x, y, z] = q;
    let mut q = Quaternion::new(w, x, y, z);
    if body == Body::Frd {
        // Half a turn about x.
        q *= Quaternion::new(0.0, 1.0, 0.0, 0.0);
    }
    if world == World::Ned {
        // Half a turn about the horizontal diagonal.
        q = Quaternion::new(0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0) * q;
    }
    [q.w, q.i, q.j, q.k]
}

/// A vector of the world along the axes of a body of this attitude. NaN where the attitude is not one.
pub fn into_body(q: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let [w, x, y, z] = q;
    match UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6) {
        Some(q) => (q.inverse() * Vector3::from(v)).into(),
        None => [f64::NAN; 3],
    }
}

/// A vector along the axes of a sensor, along those of the body that it is mounted in, turned by roll, pitch and yaw.
pub fn mounted(rotation_deg: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    if rotation_deg == [0.0; 3] {
        // Not through the matrix: one component that was not measured would spoil the others.
        return v;
    }
    let [roll, pitch, yaw] = rotation_deg.map(f64::to_radians);
    (Rotation3::from_euler_angles(roll, pitch, yaw) * Vector3::from(v)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close<const N: usize>(a: [f64; N], b: [f64; N]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} is not {b:?}");
    }

    const S: f64 = FRAC_1_SQRT_2;

    #[test]
    fn north_east_down() {
        // Level and heading north: the identity from FRD to NED, a quarter turn left from FLU to ENU (q and -q are
        // one).
        close(attitude([1.0, 0.0, 0.0, 0.0], Body::Frd, World::Ned), [-S, 0.0, 0.0, -S]);
        close(World::Ned.to_enu([1.0, 2.0, 3.0]), [2.0, 1.0, -3.0]);
        close(Body::Frd.to_flu([1.0, 2.0, 3.0]), [1.0, -2.0, -3.0]);
    }

    #[test]
    fn velocity_of_the_world_seen_from_the_body() {
        // Heading north (FLU x = north): flying north is flying forward, flying east is flying right.
        let north = [S, 0.0, 0.0, S];
        close(into_body(north, [0.0, 3.0, 0.0]), [3.0, 0.0, 0.0]);
        close(into_body(north, [3.0, 0.0, 1.0]), [0.0, -3.0, 1.0]);
        assert!(into_body([0.0; 4], [1.0; 3])[0].is_nan());
        assert!(into_body([f64::NAN; 4], [1.0; 3])[0].is_nan());
    }

    #[test]
    fn a_sensor_turned_a_quarter_left() {
        // Its x axis is the body's y axis.
        close(mounted([0.0, 0.0, 90.0], [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        // Mounted upside down.
        close(mounted([180.0, 0.0, 0.0], [1.0, 2.0, 3.0]), [1.0, -2.0, -3.0]);
        assert_eq!(mounted([0.0; 3], [1.0, 2.0, f64::NAN])[..2], [1.0, 2.0]);
    }
}
