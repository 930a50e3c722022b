//! skeleton
pub mod config;
pub mod lane;
