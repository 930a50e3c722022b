//! What is computed on the way from a command to what the sensors read.

/// Something that is computed, in this order. An effect writes some and reads others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Commands of the body rates as they arrive, and as the rates follow them.
    RateCommand,
    /// The same of the thrust, and with it the throttle.
    ThrustCommand,
    /// Body rates, rad/s, and their change, rad/s2.
    BodyRates,
    AngularAcceleration,
    /// At the terminals, V.
    Voltage,
    /// When the gyro's samples were taken.
    GyroTime,
    /// How far the rates are behind their commands.
    RateError,
    /// Velocity as the log tells it, m/s.
    Velocity,
    /// Thrust and drag over mass, m/s2.
    SpecificForce,
    /// What the sensors read.
    Gyro,
    Accelerometer,
    /// What the sensors' readings, corrected, integrate to: turns, and changes of velocity.
    Integrated,
}
