//! What a full stick asks for, where neither a log nor the user says it.

use crate::base::stats::quantile;
use crate::insight::criteria::identified::BEYOND_FULL_STICK;
use crate::insight::prepare::data::Data;

/// Share of the setpoints below what counts as the most that was asked: the rest are glitches.
const ASKED: f64 = 0.999;

/// The `base` vehicle's full-stick rates, rad/s; of an axis whose setpoints plainly ask for more, what they ask.
pub fn at_least(data: &Data, base: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let all = data.flights.iter().flat_map(|f| f.quality.log.setpoint.column(k));
        let most = quantile(&all.filter(|w| w.is_finite()).map(f64::abs).collect::<Vec<_>>(), ASKED);
        if most > BEYOND_FULL_STICK.get() * base[k] { most } else { base[k] }
    })
}
