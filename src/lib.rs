//! Drone-racing policies on an ordinary CPU, in minutes.
//!
//! A track and a vehicle become a race ([`env::Race`]) that a policy learns to fly ([`ppo`]); what it learned is kept
//! ([`snapshot`]) and scored ([`eval`]).
//!
//! World frame ENU with z up, body frame front-left-up, quaternions body to world as (w, x, y, z), SI units and radians;
//! other units only where a name says so. Commands are roll, pitch and yaw rate and collective thrust, each in [-1, 1], at
//! 100 Hz. `ARCHITECTURE.md` says where what is, and why.

// Numbers, random numbers, files.
pub mod check;
pub mod document;
pub mod fsio;
pub mod lane;
pub mod rng;
pub mod stats;
// What is raced, by what, and how it moves.
pub mod dynamics;
pub mod effects;
pub mod track;
pub mod vehicle;
// Batches of vehicles, networks, flight logs, the excitation pilot, the fastest lap of a point mass.
pub mod flight;
pub mod nn;
pub mod pilot;
pub mod policy;
pub mod reference;
pub mod sim;
// The race, learning it, scoring it, recording it; the vehicle from its flights.
pub mod diagnose;
pub mod env;
pub mod eval;
pub mod fly;
pub mod identify;
pub mod ppo;
// Keeping, measuring, showing.
pub mod bench;
pub mod config;
pub mod peak;
pub mod replay;
pub mod report;
pub mod run;
pub mod snapshot;
pub mod study;
// Arguments, text, exit codes.
pub mod cli;
