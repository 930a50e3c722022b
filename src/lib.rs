//! Drone-racing policies on an ordinary CPU, in minutes; vehicles identified and diagnosed from flight logs.
//!
//! | to | use |
//! |---|---|
//! | say what is raced, by what, and how it is trained | [`Setup`], [`Track`], [`Vehicle`] |
//! | step many vehicles by hand | [`Simulation`] |
//! | train a policy, watched | [`train`], [`train_into`] |
//! | score it, keep it, ask it | [`evaluate`], [`Policy`] |
//! | record a flight in the simulator | [`fly_pilot`], [`fly_policy`] |
//! | read a flight log, and see what it is worth | [`Log`], [`check`] |
//! | get the vehicle from its flights | [`identify`] |
//! | see what the simulation gets wrong, and mend it | [`diagnose`] |
//!
//! The folder `examples/` has a program for each half: `simulate`, `train`, `identify`, `diagnose`.
//!
//! World frame ENU with z up, body frame front-left-up, quaternions body to world as (w, x, y, z), SI units and
//! radians; other units only where a name says so. Commands are roll, pitch and yaw rate and collective thrust, each in
//! [-1, 1], at 100 Hz. Everything that can fail does so with an [`Error`], whose text says what was expected, what was
//! found, where, and what to do about it.

#![cfg_attr(not(feature = "internals"), warn(missing_docs))]

// The floors are private. The crate's own tests and benchmarks open them by a feature.
#[cfg(not(feature = "internals"))]
mod base;
#[cfg(feature = "internals")]
pub mod base;
#[cfg(not(feature = "internals"))]
mod flight;
#[cfg(feature = "internals")]
pub mod flight;
#[cfg(not(feature = "internals"))]
mod insight;
#[cfg(feature = "internals")]
pub mod insight;
#[cfg(not(feature = "internals"))]
mod learn;
#[cfg(feature = "internals")]
pub mod learn;
#[cfg(not(feature = "internals"))]
mod model;
#[cfg(feature = "internals")]
pub mod model;
#[cfg(not(feature = "internals"))]
mod present;
#[cfg(feature = "internals")]
pub mod present;
#[cfg(not(feature = "internals"))]
mod race;
#[cfg(feature = "internals")]
pub mod race;

mod api;
#[doc(hidden)]
pub mod cli;

pub use api::flight::{fly_pilot, fly_policy};
pub use api::insight::{diagnose, identify, predict};
pub use api::policy::{Policy, evaluate};
pub use api::training::{Progress, Trained, train, train_into};
pub use base::check::BadInput;
pub use base::error::{Error, Result};
pub use flight::Log;
pub use flight::sensors::SensorConfig;
pub use insight::diagnose::Diagnosed;
pub use insight::diagnose::judgement::diagnosis::{Diagnosis, Verdict};
pub use insight::diagnose::judgement::finding::Status;
pub use insight::identify::IdentifyOptions;
pub use insight::identify::estimate::Estimated;
pub use insight::identify::result::Identification;
pub use insight::quality::{Quality, Severity, check};
pub use learn::ppo::train::Flow;
pub use model::track::Track;
pub use model::vehicle::Vehicle;
pub use race::config::Setup;
pub use race::env::observe::OBSERVATIONS;
pub use race::env::reset::StartPlace;
pub use race::eval::Report;
pub use race::eval::score::Benchmark;
pub use race::simulation::{Ending, Motion, Simulation, Transition};

/// The parts of a track.
pub mod track {
    pub use crate::model::track::{Gate, GateKind, Pose, Section, Volume};
}

/// The parts of a vehicle.
pub mod vehicle {
    pub use crate::model::vehicle::extension::Extension;
    pub use crate::model::vehicle::identified::{Origin, RotorChain, SensorOffsets, ThrustSource};
    pub use crate::model::vehicle::{Battery, Drag, Identified, LogSpan, MaxRates, TimeConstants};
}

/// The parts of a score.
pub mod score {
    pub use crate::race::eval::score::{GatesPassed, LapTime};
}

/// The parts of a flight log, of its sensors, and of its check.
pub mod log {
    pub use crate::flight::sensors::{Channel, Imu, Odometry, Turn, Voltmeter};
    pub use crate::flight::{Readable, Stream, VehicleKind, VehicleRecord};
    pub use crate::insight::quality::{LogFinding, ParameterCoverage, StreamSummary};
}

/// The parts of an identification.
pub mod identification {
    pub use crate::insight::identify::fits::Kept;
    pub use crate::insight::identify::result::{
        BatteryEstimate, ComparedChannel, DragEstimate, Response, ThrustEstimate,
    };
}

/// The parts of a prediction.
pub mod prediction {
    pub use crate::insight::diagnose::prediction::horizon::Horizon;
    pub use crate::insight::predict::{PredictedChannel, Prediction};
    pub use crate::insight::prepare::data::DataPart;
}

/// The parts of a diagnosis.
pub mod diagnosis {
    pub use crate::insight::diagnose::judgement::diagnosis::{Ahead, Detectable, Drift, NotDetectable, Residual};
    pub use crate::insight::diagnose::judgement::finding::{Finding, Gain, Value};
}
