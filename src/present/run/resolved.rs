//! What a run's configuration resolved to: three files, from which the run can be repeated and by which it is known.

use super::CONFIG;
use crate::base::encode;
use crate::base::error::Result;
use crate::race::config::Setup;

/// Names and contents, in a run folder.
pub fn files(setup: &Setup) -> Result<[(&'static str, String); 3]> {
    Ok([
        (CONFIG, setup.config.to_toml()),
        ("track.toml", encode::toml("the track", &setup.track)?),
        ("vehicle.toml", encode::toml("the vehicle", &setup.vehicle)?),
    ])
}
