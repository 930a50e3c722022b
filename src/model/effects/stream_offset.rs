//! The gyro is stamped late: a sample of time t carries the time t + offset.

use super::{Card, Channel, Effect, Kind, Parameter};

pub struct It;

impl Effect for It {
    const CARD: Card = Card {
        id: "stream_offset",
        name: "gyro stamped late",
        sentence: "in the log the gyro lags everything else by some milliseconds, though in flight it does not",
        kind: Kind::Sensor,
        parameters: &[Parameter { name: "offset", unit: "s", low: -0.05, high: 0.05, typical: [0.001, 0.015] }],
        channels: &[Channel::Rate, Channel::Turn],
        signature: "the gyro is shifted against the attitude, not only against the commands",
        rivals: &["rate_delay", "clock_skew"],
        manoeuvre: ("fast stick doublets on every axis", &["roll-doublets", "pitch-doublets", "yaw-doublets"]),
        shown: None,
    };
}
