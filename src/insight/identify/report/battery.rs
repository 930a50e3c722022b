//! The discharge, into the result.

use crate::insight::identify::battery;
use crate::insight::identify::estimate::Estimate;
use crate::insight::identify::result::{ComparedChannel, Identification};
use crate::insight::prepare::data::{Data, DataPart};

/// Fits rate and initial voltage.
pub fn report(data: &Data, out: &mut Identification) {
    let unknown = |why: String, out: &mut Identification| {
        out.battery.initial_v = Estimate::unknown(&why);
        out.battery.rate_v_s = Estimate::unknown(&why);
        out.assume("battery", &why);
    };
    if let Some(why) = data.why_not("battery") {
        return unknown(why, out);
    }
    let (Some(train), Some(all)) = (battery::fit(data, DataPart::Train), battery::fit(data, DataPart::All)) else {
        return unknown("too few stretches of flight for a fit".into(), out);
    };
    let validation = battery::compare(data, DataPart::Validation, &train);
    out.battery.initial_v = Estimate::of(&all, battery::INITIAL);
    out.battery.rate_v_s = Estimate::of(&all, battery::RATE);
    let whole = battery::compare(data, DataPart::All, &all);
    let lowest = whole.predicted.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = all.values[battery::INITIAL..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let base = out.vehicle.battery;
    let battery = &mut out.vehicle.battery;
    battery.full_v = highest;
    // As far as it was flown, and at least as far as the base vehicle flies its own pack.
    battery.empty_v = lowest.min(highest * base.empty_v / base.full_v);
    battery.rate_v_s = all.values[battery::RATE].min(0.0);
    if all.values[battery::RATE] > 0.0 {
        out.remark("battery: the voltage rises in flight; the vehicle file says that it stays".into());
    }
    out.remember("battery.full_v", out.battery.initial_v.interval());
    out.remember("battery.rate_v_s", out.battery.rate_v_s.interval());
    let train = battery::compare(data, DataPart::Train, &train);
    out.battery.score = Some(validation.score());
    out.channels.push(ComparedChannel::new("voltage", "V", 1.0, &train, &validation));
}
