//! skeleton
pub mod check;
pub mod config;
pub mod document;
pub mod dynamics;
pub mod env;
pub mod eval;
pub mod lane;
pub mod nn;
pub mod peak;
pub mod policy;
pub mod ppo;
pub mod rng;
pub mod sim;
pub mod stats;
pub mod track;
pub mod vehicle;
