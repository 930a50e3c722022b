//! What is raced, by what, and how it moves: pure equations, and what the compact model can get wrong.

pub mod attitude;
pub mod constants;
pub mod dynamics;
pub mod effects;
pub mod sim;
pub mod thrust;
pub mod track;
pub mod vehicle;
