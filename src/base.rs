//! Numbers, random numbers, files: nothing of racing.

pub mod check;
pub mod claim;
pub mod document;
pub mod encode;
pub mod error;
pub mod fsio;
pub mod lane;
pub mod memory;
pub mod peak;
pub mod rng;
pub mod round_trip;
pub mod stats;
pub mod stopwatch;
pub mod threads;
pub mod wait;
