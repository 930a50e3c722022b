//! Directions of form: what the rate response of a real flight controller has beside a lag and a delay, how the thrust
//! of real motors goes with throttle and voltage together, and whether a velocity that comes late lags or is delayed.

/// The rate response is bent by the simulated rate's change so long before, s: at each time on each axis.
pub const TAPS_S: [f64; 4] = [0.01, 0.025, 0.05, 0.1];
/// A bend of the response by so much, s, is about that of a short lag.
pub const TAP_S: f64 = 0.002;
/// How many numbers bend the response.
pub const RESPONSE: usize = 3 * TAPS_S.len();
/// How many bend the thrust.
pub const THRUST: usize = 2;
/// How many bend a lagging velocity: the share of its lag that is a delay.
pub const VELOCITY: usize = 1;
/// How many numbers bend anything.
pub const COUNT: usize = RESPONSE + THRUST + VELOCITY;

/// What the thrust is bent by, of a `command` in -1..1: rotors turn at a speed that goes with throttle times voltage.
/// The thrust then has the squares of both, where Eq. 7 of the paper has the voltage and its product with the command.
/// `voltage` is relative to that at the middle of the battery, less 1.
pub fn thrust(command: f64, voltage: f64) -> [f64; THRUST] {
    [command * command * voltage, voltage * voltage]
}
