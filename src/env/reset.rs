//! Where an episode starts: on the pad, or somewhere along the track at speed.

use crate::check::{Check, Invalid};
use serde::{Deserialize, Serialize};

/// Spread of the starting states (paper section 4.5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResetConfig {
    /// Share of episodes that start on the pad, at rest, as a race does; the others start along the spline.
    pub pad_share: f64,
    /// Speed along the spline, `[low, high]`, drawn evenly, m/s.
    pub speed_m_s: [f64; 2],
    /// Standard deviation of each coordinate about the spline, m.
    pub position_m: f64,
    /// Standard deviation of the direction of flight about the spline's, deg.
    pub direction_deg: f64,
    /// Half width of the even spread of roll and of pitch about level, deg.
    pub tilt_deg: f64,
    /// Half width of the even spread of the heading about the direction of flight, deg.
    pub yaw_deg: f64,
}

impl Check for ResetConfig {
    fn check(&self) -> Result<(), Invalid> {
        Invalid::unless((0.0..=1.0).contains(&self.pad_share), "pad_share", self.pad_share, "a share, 0 to 1", "")?;
        Invalid::unless_range("speed_m_s", self.speed_m_s, 0.0, "")?;
        Invalid::unless_not_negative("position_m", self.position_m, "")?;
        for (key, value) in
            [("direction_deg", self.direction_deg), ("tilt_deg", self.tilt_deg), ("yaw_deg", self.yaw_deg)]
        {
            Invalid::unless((0.0..=180.0).contains(&value), key, value, "0 to 180 degrees", "")?;
        }
        Ok(())
    }
}
