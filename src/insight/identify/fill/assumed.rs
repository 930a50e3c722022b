//! What was assumed and decides how the vehicle flies.

use crate::insight::identify::IdentifyOptions;
use crate::insight::identify::result::Identification;

/// Says so, and how to do without.
pub fn say_what_matters(out: &mut Identification, options: &IdentifyOptions) {
    if out.lent("full_rate_deg_s").is_some() && out.kept.rate.contains(&true) {
        let base = &options.base;
        let [r, p, y] = out.full_rate_rad_s.map(f64::to_degrees);
        let more = if out.full_rate_rad_s == base.max_rates_rad_s() { "" } else { ", or what the log asks for beyond" };
        out.remark(format!(
            "full-stick rates are those of {}{more} ({r:.0}, {p:.0}, {y:.0} deg/s): give --full-rates as they are \
             configured",
            base.name
        ));
    }
    if out.lent("mass_kg").is_some() && out.thrust.full_n.value.is_some() {
        let mass = out.vehicle.mass_kg;
        out.remark(format!("forces in newtons are those of a mass of {mass} kg, which is assumed: give --mass"));
    }
}
