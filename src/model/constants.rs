//! Constants that every floor above shares.

/// Gravity where no vehicle file says another, m/s2: pilots and checks of logs take this.
pub const GRAVITY_M_S2: f64 = 9.81;

/// Period of the commands and of the simulation's step, s: the paper's 100 Hz.
pub const CONTROL_S: f64 = 0.01;
