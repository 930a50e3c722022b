//! What is said of what was selected: how sure it is, what else it may be, and what it changes.

pub mod adequacy;
pub mod cause;
pub mod constant;
pub mod detectable;
pub mod diagnosis;
pub mod doubt;
pub mod drift;
pub mod finding;
pub mod findings;
pub mod gusts;
pub mod impact;
pub mod judge;
pub mod late_gyro;
pub mod one_motor;
pub mod parts;
pub mod pays;
pub mod replication;
pub mod set_aside;
pub mod shown;
