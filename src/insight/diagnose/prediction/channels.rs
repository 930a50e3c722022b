//! The channels of the residual, each along one axis.

use crate::model::effects::ResidualChannel;

/// Channels of the residual: rates, specific force, turns and pushes along x, y, z, and the voltage.
pub const CHANNELS: usize = 13;
pub const RATE: usize = 0;
pub const FORCE: usize = 3;
/// Specific force along the rotors' axis.
pub const LIFT: usize = FORCE + 2;
pub const TURN: usize = 6;
pub const PUSH: usize = 9;
pub const VOLTAGE: usize = 12;
/// What a vehicle predicts: rates, specific force and voltage. Turns and pushes are the sensors' own.
pub const OF_VEHICLE: [usize; 7] = [0, 1, 2, 3, 4, 5, VOLTAGE];

/// What a channel compares.
pub fn kind(channel: usize) -> ResidualChannel {
    [
        ResidualChannel::Rate,
        ResidualChannel::Force,
        ResidualChannel::Turn,
        ResidualChannel::Push,
        ResidualChannel::Voltage,
    ][channel / 3]
}

/// Names and units of all channels.
pub const NAMES: [(&str, &str); CHANNELS] = [
    ("roll rate", "rad/s"),
    ("pitch rate", "rad/s"),
    ("yaw rate", "rad/s"),
    ("specific force x", "m/s2"),
    ("specific force y", "m/s2"),
    ("specific force z", "m/s2"),
    ("turn x", "rad"),
    ("turn y", "rad"),
    ("turn z", "rad"),
    ("push x", "m/s"),
    ("push y", "m/s"),
    ("push z", "m/s"),
    ("voltage", "V"),
];
