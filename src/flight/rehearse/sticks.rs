//! What a rehearsal asks of a firmware: a pilot's sticks.

/// Sticks and the switch that arms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sticks {
    /// Roll right, nose down, yaw left: shares of the full rates, -1..1.
    pub rates: [f64; 3],
    /// 0..1; none is closed, below what flies, as arming asks for.
    pub throttle: Option<f64>,
    pub armed: bool,
}
