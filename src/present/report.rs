//! Pictures of a run. They draw numbers and compute none.

// Benchmarks draw it.
#[cfg(feature = "internals")]
pub mod beside;
pub mod commands;
pub mod diagnosis;
pub mod figures;
mod flown;
pub mod folder;
mod health;
pub mod identification;
pub mod lap;
mod map;
mod page;
mod plot;
pub mod replay;
pub mod run;
mod signals;
pub mod spread;
pub mod study;
pub mod training;

pub use page::{digits, range};

use crate::base::error::Error;

/// A page, and its figures by the names of their files.
#[derive(Clone, Debug)]
pub struct Drawn {
    pub page: String,
    pub figures: Vec<(String, String)>,
}

/// The error of a drawing.
pub fn drawing(error: impl std::fmt::Display) -> Error {
    Error::Draw(error.to_string())
}
