//! The program as its users meet it: what they type, what is printed where, what is left on disk.

mod against;
mod cli;
mod criteria;
mod diagnose_report;
mod examples;
mod export;
mod faults;
mod identify;
mod import;
mod kills;
mod library;
mod pilot;
mod plan;
mod predict;
#[cfg(unix)]
mod rehearse;
mod show;
mod study;
#[path = "../support/mod.rs"]
mod support;
