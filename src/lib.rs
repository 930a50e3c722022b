//! skeleton
pub mod check;
pub mod config;
pub mod document;
pub mod env;
pub mod eval;
pub mod lane;
pub mod ppo;
pub mod track;
pub mod vehicle;
