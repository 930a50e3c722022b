//! Numbers of the model fitted to flights: whitening, Gauss-Newton, what a size is, and what is judged on flight that
//! no fit has seen.

pub mod agreement;
pub mod bend;
pub mod fit;
pub mod score;
pub mod size;
pub mod skew;
pub mod told;
pub mod unseen;
pub mod whiten;
