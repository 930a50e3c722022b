//! The program as its users meet it: what they type, what is printed where, what is left on disk.

mod against;
mod check;
mod cli;
mod criteria;
mod diagnose_report;
mod examples;
mod export;
mod extend;
mod faults;
mod identify;
mod import;
mod kills;
mod library;
mod pilot;
mod plan;
mod predict;
mod refused;
#[cfg(unix)]
mod rehearse;
mod show;
mod study;
#[path = "../support/mod.rs"]
mod support;
