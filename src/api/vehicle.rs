//! Vehicles and set-ups, made and kept.

use crate::base::check::{BadInput, Check};
use crate::base::encode;
use crate::base::error::{Error, Result};
use crate::base::fsio::write_new;
use crate::model::vehicle::Vehicle;
use crate::race::config::{DEFAULT, Setting, Setup};
use std::path::Path;

impl Setup {
    /// The built-in configuration with these settings, each as `key=value`, such as `track=square` or
    /// `budget.minutes=2`. `racer train --help` lists all keys. Track and vehicle are names of built-in ones, or files.
    /// Fails on anything that makes no sense, alone or together.
    pub fn new(settings: &[&str]) -> Result<Self> {
        Self::from_file(DEFAULT, settings)
    }

    /// The configuration of this name or file, with these settings in place of its own. A file needs only the keys that
    /// differ from the built-in configuration, `a2rl`.
    pub fn from_file(name: &str, settings: &[&str]) -> Result<Self> {
        let settings = settings.iter().map(|text| Setting::parse(text)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self::load(name, &settings)?)
    }
}

impl Vehicle {
    /// Writes a new TOML file, which [`Vehicle::load`] and `racer train --vehicle` read; nothing that exists is
    /// overwritten.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        write_new(path, encode::toml("the vehicle", self)?.as_bytes()).map_err(Error::write(path))
    }

    /// The vehicle with an effect beyond the compact model, such as `axial_inflow`, `k`, 0.5. `racer extend` lists
    /// effects, parameters and usual sizes. Fails on an unknown one, or a size out of bounds.
    pub fn with_effect(mut self, effect: &str, parameter: &str, size: f64) -> Result<Self> {
        self.effects.sizes.entry(effect.into()).or_default().insert(parameter.into(), size);
        self.check().map_err(|invalid| BadInput::at("an effect", invalid))?;
        Ok(self)
    }
}
