//! What the crate shows to those who use it as a library. Everything here is thin: the work is done on the floors
//! below.

pub mod flight;
pub mod insight;
pub mod policy;
pub mod training;
pub mod vehicle;
