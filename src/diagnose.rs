//! What the simulation gets wrong, and why: from the residuals of a flight to the effects that explain them.

pub mod drift;
pub mod finding;
pub mod fit;
pub mod gain;
pub mod gram;
pub mod horizon;
pub mod judge;
pub mod model;
pub mod predict;
pub mod problem;
pub mod random;
pub mod record;
pub mod select;
pub mod structure;
pub mod whiten;
