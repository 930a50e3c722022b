//! Drone-racing policies on an ordinary CPU, in minutes.
//!
//! A track and a vehicle become a race ([`env::Race`]) that a policy learns to fly ([`ppo`]); what it learned is kept
//! ([`snapshot`]) and scored ([`eval`]).
//!
//! World frame ENU with z up, body frame front-left-up, quaternions body to world as (w, x, y, z), SI units and radians;
//! other units only where a name says so. Commands are roll, pitch and yaw rate and collective thrust, each in [-1, 1], at
//! 100 Hz. `ARCHITECTURE.md` says where what is, and why.

// The floors are private. The crate's own tests and benchmarks open them by a feature.
#[cfg(not(feature = "internals"))]
mod base;
#[cfg(feature = "internals")]
pub mod base;
#[cfg(not(feature = "internals"))]
mod flight;
#[cfg(feature = "internals")]
pub mod flight;
#[cfg(not(feature = "internals"))]
mod insight;
#[cfg(feature = "internals")]
pub mod insight;
#[cfg(not(feature = "internals"))]
mod learn;
#[cfg(feature = "internals")]
pub mod learn;
#[cfg(not(feature = "internals"))]
mod model;
#[cfg(feature = "internals")]
pub mod model;
#[cfg(not(feature = "internals"))]
mod present;
#[cfg(feature = "internals")]
pub mod present;
#[cfg(not(feature = "internals"))]
mod race;
#[cfg(feature = "internals")]
pub mod race;

#[doc(hidden)]
pub mod cli;
