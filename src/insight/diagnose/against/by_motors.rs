//! What changed by what the motors are sent, which no simulation is asked for.

mod gains;
mod moved;
mod turning;

use super::change::Change;
use crate::insight::diagnose::motor_loop::MotorLoop;

/// Adds what the motors tell from one set of flights to the other; what follows from it makes room.
pub fn add(loops: &[MotorLoop; 2], changes: &mut Vec<Change>) {
    gains::replace_response(loops, changes);
    turning::replace_what_follows(loops, changes);
}
