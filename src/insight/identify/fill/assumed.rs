//! What was assumed and decides how the vehicle flies.

use crate::base::stats::quantile;
use crate::insight::criteria::identified::BEYOND_FULL_STICK;
use crate::insight::identify::result::Identification;
use crate::insight::prepare::data::Data;

/// Says so, and how to do without.
pub fn say_what_matters(out: &mut Identification, data: &Data) {
    if out.lent("full_rate_deg_s").is_some() && out.kept.rate.contains(&true) {
        let most = |k: usize| {
            let all = data.flights.iter().flat_map(|f| f.quality.log.setpoint.column(k));
            quantile(&all.filter(|w| w.is_finite()).map(f64::abs).collect::<Vec<_>>(), 0.999)
        };
        let most: [f64; 3] = std::array::from_fn(most);
        let full = out.full_rate_rad_s;
        let base = out.vehicle.identified.as_ref().map_or("", |i| &i.base).to_string();
        let [r, p, y] = full.map(f64::to_degrees);
        let mut text = format!(
            "full-stick rates are those of {base} ({r:.0}, {p:.0}, {y:.0} deg/s): give --full-rates as they are \
             configured"
        );
        let beyond = (0..3).any(|k| most[k] > BEYOND_FULL_STICK.get() * full[k]);
        if beyond {
            let [r, p, y] = most.map(f64::to_degrees);
            text += &format!("; the log asks for more, up to {r:.0}, {p:.0}, {y:.0} deg/s");
        }
        out.remark(text);
    }
    if out.lent("mass_kg").is_some() && out.thrust.full_n.value.is_some() {
        let mass = out.vehicle.mass_kg;
        out.remark(format!("forces in newtons are those of a mass of {mass} kg, which is assumed: give --mass"));
    }
}
