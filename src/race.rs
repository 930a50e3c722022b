//! Gates, observation, reward, ends and beginnings of episodes; scoring and keeping what learned to race.

pub mod config;
pub mod env;
pub mod eval;
pub mod heat;
pub mod reference;
pub mod snapshot;
pub mod train;
