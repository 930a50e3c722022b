//! Directions of form: what the rate response of a real flight controller has beside a lag and a delay.

/// The rate response is bent by the simulated rate's change so long before, s: at each time on each axis.
pub const TAPS_S: [f64; 4] = [0.01, 0.025, 0.05, 0.1];
/// A bend of the response by so much, s, is about that of a short lag.
pub const TAP_S: f64 = 0.002;
/// How many numbers bend it.
pub const COUNT: usize = 3 * TAPS_S.len();
