//! How numbers are estimated from samples, once for identification and diagnosis: bounded least squares, weights that
//! outliers do not rule, noise that remembers, and intervals that hold for it.

pub mod autoregression;
pub mod gram;
pub mod halfspace;
pub mod inverse;
pub mod jackknife;
pub mod least_squares;
pub mod range;
pub mod robust;
