//! Gates, observation, reward, ends and beginnings of episodes; scoring and keeping what learned to race.

pub mod act;
pub mod checkpoint;
pub mod config;
pub mod env;
pub mod eval;
pub mod heat;
pub mod onboard;
pub mod reference;
pub mod simulation;
pub mod snapshot;
pub mod train;
