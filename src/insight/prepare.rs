//! Checked logs as flights on one clock, for identification and diagnosis alike.

pub mod attitude;
pub mod data;
pub mod flight;
pub mod kept_steps;
pub mod lag;
pub mod lately;
pub mod rotors;
pub mod windows;
