//! What a run's configuration resolved to: three files, from which the run can be repeated and by which it is known.

use crate::race::config::Setup;

/// Names and contents, in a run folder.
pub fn files(setup: &Setup) -> anyhow::Result<[(&'static str, String); 3]> {
    Ok([
        ("config.toml", setup.config.to_toml()),
        ("track.toml", toml::to_string(&setup.track)?),
        ("vehicle.toml", toml::to_string(&setup.vehicle)?),
    ])
}
