//! Fits, judged and put into the result and its vehicle.

pub mod battery;
pub mod force;
pub mod rates;
