//! What passes each stage of the extended model, and may be changed there.

/// Time between a command and its arrival, s.
#[derive(Clone, Copy, Debug)]
pub struct CommandDelay<R> {
    pub rates: R,
    /// Of yaw, beyond that of all rates.
    pub yaw: R,
    pub thrust: R,
}

/// Commands before the lag.
#[derive(Clone, Copy, Debug)]
pub struct CommandSetpoint<R> {
    /// Roll, pitch, yaw, thrust, -1..1.
    pub command: [R; 4],
    /// Filtered throttle, 0..1.
    pub throttle: R,
    /// Body rates that the filtered commands stand for, rad/s.
    pub rates: [R; 3],
    /// Their time constants, s, and the rates at full command, rad/s.
    pub tau: [R; 4],
    pub max_rate: [R; 3],
}

/// How rates and thrust follow their commands.
#[derive(Clone, Copy, Debug)]
pub struct Actuator<R> {
    /// Time constants of roll, pitch, yaw, thrust, s.
    pub tau: [R; 4],
    /// That of falling thrust, s.
    pub tau_down: R,
    /// T2 of T2 w'' + tau w' + w = w_sp, of each axis, s2.
    pub inertia: [R; 3],
    /// One over the largest angular acceleration of each axis, s2/rad.
    pub slew: [R; 3],
    /// So many times longer the whole response of the rates takes.
    pub slower: R,
    /// How much the terminal voltage is below full, V.
    pub missing_v: R,
}

/// From filtered commands to body rates.
#[derive(Clone, Copy, Debug)]
pub struct BodyRates<R> {
    /// Body frame, rad/s.
    pub rates: [R; 3],
    /// Filtered throttle, 0..1.
    pub throttle: R,
}

/// The battery under load.
#[derive(Clone, Copy, Debug)]
pub struct BatteryLoad<R> {
    /// Current as a share of that at full throttle: the filtered throttle (0..1) squared.
    pub load: R,
    /// Time since the last call, s; 0 to look only.
    pub dt: R,
    /// 1 full, 0 empty.
    pub charge: R,
    /// Voltage lost to slow polarisation, V; carried from call to call.
    pub polarisation: R,
    /// Voltage between open circuit and terminals, V.
    pub drop: R,
}

/// What reaches the thrust curve.
#[derive(Clone, Copy, Debug)]
pub struct ThrustInput<R> {
    /// Filtered thrust command, -1..1.
    pub command: R,
    /// Terminal voltage, V.
    pub voltage: R,
    /// Half way between full and empty, V.
    pub middle_v: R,
    /// Sum over the axes of |command - response|, rad/s.
    pub behind: R,
}

/// Motion through the air.
#[derive(Clone, Copy, Debug)]
pub struct RelativeWind<R> {
    /// The body's axes in the world.
    pub axes: [[R; 3]; 3],
    /// Velocity through the air, body frame, m/s.
    pub velocity: [R; 3],
}

/// Thrust and drag.
#[derive(Clone, Copy, Debug)]
pub struct AerodynamicForces<R> {
    /// Filtered throttle, 0..1.
    pub throttle: R,
    /// Velocity through the air, body frame, m/s.
    pub velocity: [R; 3],
    /// The compact model's drag along each body axis, 1/m, and its factor on this velocity, 1/s.
    pub drag: [R; 3],
    pub damping: R,
    /// Body rates, rad/s.
    pub rates: [R; 3],
    /// Over the ground, m.
    pub height: R,
    /// Sum over the axes of |command - response|, each as a share of the maximum rate.
    pub rate_error: R,
    /// Time since the battery was full, s.
    pub elapsed: R,
    /// Specific thrust (thrust over mass), m/s2.
    pub specific_thrust: R,
    /// Everything else, body frame, m/s2.
    pub force: [R; 3],
}

/// A reading of the IMU: the truth on entry, what the sensor says on leaving.
#[derive(Clone, Copy, Debug)]
pub struct Sensed {
    /// Body rates, rad/s.
    pub rates: [f64; 3],
    /// Their change, rad/s2; for use, not to be written.
    pub acceleration: [f64; 3],
    /// Specific force, m/s2.
    pub force: [f64; 3],
    /// Filtered throttle, 0..1.
    pub throttle: f64,
}
