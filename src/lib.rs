//! Drone-racing policies on an ordinary CPU, in minutes.
//!
//! A track and a vehicle become a race ([`env::Race`]) that a policy learns to fly ([`ppo`]); what it learned is kept
//! ([`snapshot`]) and scored ([`eval`]).
//!
//! World frame ENU with z up, body frame front-left-up, quaternions body to world as (w, x, y, z), SI units and radians;
//! other units only where a name says so. Commands are roll, pitch and yaw rate and collective thrust, each in [-1, 1], at
//! 100 Hz. `ARCHITECTURE.md` says where what is, and why.

pub mod base;
pub mod cli;
pub mod flight;
pub mod insight;
pub mod learn;
pub mod model;
pub mod present;
pub mod race;
