//! Keeping, measuring, showing: run folders, studies, reports, replays, benchmarks.

pub mod bench;
pub mod colour;
pub mod export;
pub mod predict;
pub mod replay;
pub mod report;
pub mod retrain;
pub mod run;
pub mod study;
pub mod train;
