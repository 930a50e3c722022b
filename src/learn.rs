//! Networks and how they learn: knows neither tracks nor vehicles.

pub mod nn;
pub mod policy;
pub mod ppo;
