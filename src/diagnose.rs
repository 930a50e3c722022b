//! What the simulation gets wrong, and why: from the residuals of a flight to the effects that explain them.

pub mod fit;
pub mod gram;
pub mod model;
pub mod predict;
pub mod problem;
pub mod record;
pub mod select;
pub mod whiten;
