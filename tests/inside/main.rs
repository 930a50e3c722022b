//! The parts of the library, each against numbers and rules known without it.

mod against;
mod blackbox;
mod cards;
mod chain;
mod config;
mod corpus;
mod dependence;
mod dynamics;
mod effects;
mod export;
mod fly;
mod golden_ppo;
mod gradients;
mod hidden_effects;
mod lane;
mod live;
mod mappings;
mod mcap;
mod older;
mod operations;
mod plan;
mod policy_file;
mod python;
mod quality;
mod race;
mod rate_loop;
mod reference;
mod rehearse;
mod replay;
mod resume;
mod round_trip;
mod rules;
mod states;
#[path = "../support/mod.rs"]
mod support;
mod track;
mod training;
#[path = "../truth/mod.rs"]
mod truth;
mod truth_hidden;
mod truth_other;
mod truth_physics;
mod unseen;
mod written;
