//! The state of a vehicle with everything that may be hidden in it.

use nalgebra::{Quaternion, UnitQuaternion, Vector2, Vector3, Vector4};

/// World ENU, body front-left-up, attitude body to world. The same fields hold its change per second.
#[derive(Clone, Copy, Debug)]
pub struct Craft {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: Quaternion<f64>,
    /// What the inner loop has reached, rad/s; body rates but for coupling.
    pub rates: Vector3<f64>,
    /// Change of `rates` where it is a state of its own, rad/s2.
    pub spin: Vector3<f64>,
    /// Filtered thrust command, -1..1.
    pub u: f64,
    /// Outputs of the motors, 0..1, where they are modelled one by one.
    pub motors: Vector4<f64>,
    /// Voltage lost in what relaxes, V.
    pub relaxed: f64,
    /// Share of the charge that has been taken, where it follows the load.
    pub drawn: f64,
    /// Velocity as the estimator has it, world, m/s, and what its observer corrects it by, m/s2.
    pub estimate: Vector3<f64>,
    pub correction: Vector3<f64>,
    /// Deflection and its speed of what swings.
    pub swing: Vector2<f64>,
    pub swinging: Vector2<f64>,
    /// Whether the ground carries it.
    pub resting: bool,
}

impl Craft {
    /// At rest, closed throttle, battery full.
    pub fn on_ground() -> Self {
        Craft { attitude: Quaternion::identity(), u: -1.0, resting: true, ..Self::still() }
    }

    /// Nothing changes.
    pub fn still() -> Self {
        Craft {
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            attitude: Quaternion::new(0.0, 0.0, 0.0, 0.0),
            rates: Vector3::zeros(),
            spin: Vector3::zeros(),
            u: 0.0,
            motors: Vector4::zeros(),
            relaxed: 0.0,
            drawn: 0.0,
            estimate: Vector3::zeros(),
            correction: Vector3::zeros(),
            swing: Vector2::zeros(),
            swinging: Vector2::zeros(),
            resting: false,
        }
    }

    /// Moved by the change `by` for `dt` seconds.
    pub fn moved(&self, by: &Craft, dt: f64) -> Self {
        Craft {
            position: self.position + by.position * dt,
            velocity: self.velocity + by.velocity * dt,
            attitude: self.attitude + by.attitude * dt,
            rates: self.rates + by.rates * dt,
            spin: self.spin + by.spin * dt,
            u: self.u + by.u * dt,
            motors: self.motors + by.motors * dt,
            relaxed: self.relaxed + by.relaxed * dt,
            drawn: self.drawn + by.drawn * dt,
            estimate: self.estimate + by.estimate * dt,
            correction: self.correction + by.correction * dt,
            swing: self.swing + by.swing * dt,
            swinging: self.swinging + by.swinging * dt,
            resting: self.resting,
        }
    }

    pub fn rotation(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_quaternion(self.attitude)
    }

    /// Throttle share, 0..1.
    pub fn share(&self) -> f64 {
        0.5 * (1.0 + self.u)
    }
}
