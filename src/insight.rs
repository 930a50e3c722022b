//! What flights say: whether a log is fit to learn from, the vehicle in it, and what the compact model gets wrong.

pub mod criteria;
pub mod diagnose;
pub mod estimate;
pub mod identify;
pub mod plan;
pub mod predict;
pub mod prepare;
pub mod quality;

/// Is told what is being done, and the share done so far, before each step.
pub type Watch<'a> = &'a mut dyn FnMut(&str, f64);
