//! The configuration of a training run: one TOML file, changed from the command line, checked as a whole.
//!
//! A file needs to hold only what differs from the built-in `a2rl.toml`, which sets every key. Each table is a struct
//! in the module that uses it; this module only puts them together. The file of a run sets every key; in one that an
//! older racer wrote, keys that came later have their old meaning ([`later`]).

pub mod later;
mod layers;
mod setting;

pub use crate::base::check::{BadInput, Check, Invalid};
pub use setting::Setting;

use crate::base::document::Library;
use crate::learn::ppo::config::{BudgetConfig, PpoConfig};
use crate::model::track::{GateKind, Track};
use crate::model::vehicle::Vehicle;
use crate::race::env::EnvConfig;
use crate::race::eval::EvalConfig;
use layers::Layers;
use serde::{Deserialize, Serialize};

/// Name of the configuration that is used when none is named.
pub const DEFAULT: &str = "a2rl.toml";

const LIBRARY: Library =
    Library { kind: "configuration", folder: "configs", builtin: &[("a2rl", A2RL), ("a2rl_many_cores", MANY_CORES)] };
const A2RL: &str = include_str!("../../configs/a2rl.toml");
const MANY_CORES: &str = include_str!("../../configs/a2rl_many_cores.toml");

/// Everything that decides the outcome of a training run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Track to race on: name or file.
    pub track: String,
    /// Vehicle to race with: name or file.
    pub vehicle: String,
    /// Where all random numbers start: same seed, same result, whatever the number of threads.
    pub seed: u64,
    pub budget: BudgetConfig,
    pub env: EnvConfig,
    pub ppo: PpoConfig,
    pub eval: EvalConfig,
}

impl Config {
    /// Finds `name` in the working directory, in `configs/` or among the built-in ones, applies `settings` in order,
    /// and checks the result. Keys that neither sets are those of the built-in `a2rl.toml`.
    pub fn load(name: &str, settings: &[Setting]) -> Result<Self, BadInput> {
        Layers::open(name, settings)?.resolve()
    }

    /// The track it names.
    pub fn load_track(&self) -> Result<Track, BadInput> {
        Track::load(&self.track)
    }

    /// The vehicle it names.
    pub fn load_vehicle(&self) -> Result<Vehicle, BadInput> {
        Vehicle::load(&self.vehicle)
    }

    /// The configuration as a complete TOML file, from which the run can be repeated.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a checked configuration consists of tables, numbers and strings only")
    }
}

/// A configuration with the track and the vehicle that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    #[doc(hidden)]
    pub config: Config,
    /// What is raced on.
    pub track: Track,
    /// What is raced with; may be replaced by another one.
    pub vehicle: Vehicle,
}

impl Setup {
    /// As the configuration is loaded, with the files it names; checks that they fit together.
    #[doc(hidden)]
    pub fn load(name: &str, settings: &[Setting]) -> Result<Self, BadInput> {
        let layers = Layers::open(name, settings)?;
        let config = layers.resolve()?;
        let setup = Self { track: config.load_track()?, vehicle: config.load_vehicle()?, config };
        setup.check().map_err(|invalid| layers.blame(invalid))?;
        Ok(setup)
    }
}

/// What only the three together can violate; each is checked for itself when it is read.
impl Check for Setup {
    fn check(&self) -> Result<(), Invalid> {
        let Self { config, track, .. } = self;
        let physical = track.gates.iter().filter(|gate| gate.kind == GateKind::Physical);
        let narrowest = physical.map(|gate| gate.radius_m).fold(f64::INFINITY, f64::min);
        let radius = config.env.gate_radius_m;
        let expected = format!("at most {narrowest} m, the narrowest gate of {}", track.name);
        Invalid::unless(radius <= narrowest, "env.gate_radius_m", radius, &expected, "train with less than is scored")
    }
}

impl Check for Config {
    fn check(&self) -> Result<(), Invalid> {
        let largest = i64::MAX as u64;
        Invalid::unless(self.seed <= largest, "seed", self.seed, &format!("at most {largest}"), "TOML has no larger")?;
        self.budget.check().map_err(|invalid| invalid.within("budget"))?;
        self.env.check().map_err(|invalid| invalid.within("env"))?;
        self.ppo.check().map_err(|invalid| invalid.within("ppo"))?;
        self.eval.check().map_err(|invalid| invalid.within("eval"))
    }
}
