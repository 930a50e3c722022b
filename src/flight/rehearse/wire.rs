//! The way to a firmware and back, whichever it is.

use super::sticks::Sticks;
use crate::base::error::Result;
use crate::flight::instruments::Actual;
use std::fmt::Debug;

/// How a rehearsal speaks with one kind of firmware.
pub trait FirmwareWire: Debug {
    /// Body rates of full sticks, rad/s, of a firmware that was set up for at least `wanted`.
    fn full_rates(&self, wanted: [f64; 3]) -> [f64; 3];

    /// How many control periods it needs, at most: at rest before it is armed, and from then until its motors turn.
    fn patience(&self) -> [usize; 2];

    /// Waits until the firmware has booted far enough for the first step. Fails where it does not.
    fn begin(&mut self) -> Result<()>;

    /// Sticks that are held from the next step on. Fails where the firmware does not take them.
    fn hold(&mut self, sticks: &Sticks) -> Result<()>;

    /// A step of the firmware, which sees the vehicle as it is `now`, and of its body rates (rad/s) and specific force
    /// (m/s2) what was measured, `imu`. What it sends each motor then, 0..1, in the order of
    /// [`Airframe`](super::airframe::Airframe); none where it said nothing new. Fails where it is silent or gone.
    fn step(&mut self, now: &Actual, imu: &[f64; 6]) -> Result<Option<[f64; 4]>>;

    /// Whether it said that it can be armed, for one that says so.
    fn ready(&self) -> bool {
        false
    }

    /// Steps that began late, and all, by the wall; none in lockstep.
    fn late(&self) -> Option<[u64; 2]> {
        None
    }

    /// The last that the firmware said of itself over this way, if it says anything.
    fn said(&self) -> Option<String> {
        None
    }
}
