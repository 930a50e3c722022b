//! Every fit to one part of the flights, and the vehicle that they make.

use super::estimate::Estimated;
use super::force_terms::{DRAG_AT, ForceTerms, OFFSET, TAU, THRUST};
use super::rate_loop::{self, RateLoop, RateLoopForm};
use super::rates::{LookedFor, RateAxis};
use super::solve::Solution;
use super::thrust::{self, ThrustFit};
use super::{IdentifyOptions, battery, bias, room};
use crate::base::stats::NORMAL_95;
use crate::insight::prepare::data::{Data, DataPart};
use crate::model::dynamics::drag::{ellipsoid, semi_axes};
use crate::model::effects::{self, ControllerPart};
use crate::model::vehicle::extension::Extension;
use crate::model::vehicle::identified::SensorOffsets;
use crate::model::vehicle::{AXES, MaxRates, TimeConstants, Vehicle};
use rayon::prelude::*;

const TOO_SHORT: &str = "too few stretches of flight for a fit";

/// Fits, or why there is none.
pub struct Fits {
    /// Roll, pitch, yaw: time constant (s), gain, offset (rad/s).
    pub rates: [Result<Solution, String>; 3],
    /// What they have beside that.
    pub rate_loop: RateLoop,
    /// Gain with which the mixer makes room for turns, s/rad, where the motors tell it.
    pub room: Option<Estimated>,
    /// As [`battery::fit`] orders it.
    pub battery: Result<Solution, String>,
    pub thrust: Result<ThrustFit, String>,
    /// Why the drag is not a part of that.
    pub no_drag: Option<String>,
    /// Why the voltage is no part of the thrust curve.
    pub no_voltage: Option<String>,
    /// The accelerometer's bias along x, y, z, m/s2.
    pub bias: Option<Solution>,
}

/// Which numbers of the fits a vehicle takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    /// Time constants of roll, pitch, yaw, thrust.
    pub lag: [bool; 4],
    /// Maximum rates.
    pub rate: [bool; 3],
    /// The thrust curve.
    pub thrust: bool,
    /// The size of the drag.
    pub drag: bool,
    /// The voltages between which the pack was flown.
    pub volts: bool,
    /// How fast it fell.
    pub discharge: bool,
}

impl Fits {
    /// Fits everything that `part` of the flights tells. `drag` says whether its size is looked for.
    pub fn new(
        data: &Data,
        part: DataPart,
        start: &Vehicle,
        options: &IdentifyOptions,
        drag: bool,
        form: RateLoopForm,
    ) -> Self {
        let axes = [0, 1, 2].map(|axis| RateAxis::new(data, axis, options.rate_cutoff_hz));
        let rate_loop = rate_loop::fit(&axes, part, form).unwrap_or_default();
        let rate = |axis: usize| match data.why_not(&format!("{} response", AXES[axis])) {
            Some(why) => Err(why),
            None => axes[axis].fit(part, rate_loop.beside(axis), LookedFor::Nothing).ok_or(TOO_SHORT.to_string()),
        };
        let rates: Vec<_> = (0..3).into_par_iter().map(rate).collect();
        let rates: [_; 3] = rates.try_into().unwrap_or_else(|_| std::array::from_fn(|_| Err(TOO_SHORT.into())));
        let battery = match data.why_not("battery") {
            Some(why) => Err(why),
            None => battery::fit(data, part).ok_or(TOO_SHORT.to_string()),
        };
        let no_drag = data.why_not("drag").or_else(|| (!drag).then(|| "not told by this flight".into()));
        // A curve over a voltage of which no pack is known would be no vehicle.
        let no_voltage = data.why_not("thrust over voltage").or_else(|| battery.as_ref().err().cloned());
        let bias = bias::fit(data, start.gravity_m_s2);
        let mut out =
            Self { rates, rate_loop, room: None, battery, thrust: Err(TOO_SHORT.into()), no_drag, no_voltage, bias };
        out.thrust = match data.why_not("thrust curve") {
            Some(why) => Err(why),
            None => {
                let terms = out.terms(data, part, start, options);
                thrust::fit(data, part, &terms).ok_or(TOO_SHORT.to_string())
            }
        };
        if let (Ok(thrust), [Ok(roll), Ok(pitch), Ok(yaw)]) = (&out.thrust, &out.rates)
            && let Some(mixer) = &thrust.mixer
        {
            out.room = room::fit(data, part, &mixer.chain, [roll, pitch, yaw], &out.rate_loop);
        }
        out
    }

    fn terms(&self, data: &Data, part: DataPart, start: &Vehicle, options: &IdentifyOptions) -> ForceTerms {
        let drag = self.no_drag.is_none();
        let moving = data.flights.iter().any(|flight| flight.velocity[0].iter().any(|v| v.is_finite()));
        let lent = ellipsoid(&start.drag).map(|k| k / start.mass_kg);
        let pack = match &self.battery {
            Ok(solution) => battery::pack(data, part, solution, &start.battery),
            Err(_) => start.battery,
        };
        ForceTerms {
            curves: ForceTerms::curve(self.no_voltage.is_none()),
            power_at_v: None,
            drag,
            given_drag: if !drag && moving { lent } else { [0.0; 3] },
            bias: self.bias.as_ref().map_or([0.0; 3], |b| [0.0, 0.0, b.values[2]]),
            cutoff_hz: options.force_cutoff_hz,
            volts: [pack.empty_v, pack.full_v],
            gravity: start.gravity_m_s2,
        }
    }

    /// Everything that was fitted.
    pub fn everything(&self) -> Kept {
        let rate: [bool; 3] = std::array::from_fn(|axis| self.rates[axis].is_ok());
        let thrust = self.thrust.is_ok();
        let lags = self.thrust.as_ref().is_ok_and(|fit| fit.lags);
        Kept {
            lag: [rate[0], rate[1], rate[2], lags],
            rate,
            thrust,
            drag: thrust && self.no_drag.is_none(),
            volts: self.battery.is_ok(),
            discharge: self.battery.is_ok(),
        }
    }

    /// What the vehicle has of a flight controller's answer, with what is `kept` of the fits: it belongs to the lag
    /// beside it.
    pub fn controller(&self, kept: &Kept) -> Vec<(ControllerPart, &Estimated)> {
        let [roll, pitch, yaw, _] = kept.lag;
        let of_yaw = |part| matches!(part, ControllerPart::YawDelay | ControllerPart::YawInertia);
        let told = self.rate_loop.parts().into_iter().filter(|(part, _)| roll && pitch && (yaw || !of_yaw(*part)));
        told.chain(self.room.iter().filter(|_| kept.thrust).map(|k| (ControllerPart::Room, k))).collect()
    }

    /// Puts that into the effects of a vehicle in the place of its own, each to be drawn in training as far as its
    /// interval reaches.
    fn extend(&self, extension: &mut Extension, kept: &Kept) {
        if kept.lag[0] && kept.lag[1] {
            // The lag was fitted without them.
            let own = ControllerPart::OF_RATES.into_iter().filter_map(effects::of_controller);
            own.for_each(|card| extension.remove(card.id));
        }
        for (part, size) in self.controller(kept) {
            let (Some(value), Some([low, high])) = (size.value, size.interval()) else { continue };
            if let Some(card) = effects::of_controller(part) {
                extension.put(card.id, card.parameters[0].name, value, (high - low) / (2.0 * NORMAL_95));
            }
        }
    }

    /// `start` with what is `kept` of the fits.
    pub fn vehicle(&self, data: &Data, part: DataPart, start: &Vehicle, kept: &Kept, full_rate: [f64; 3]) -> Vehicle {
        let mut v = start.clone();
        let mut sensors = SensorOffsets::default();
        let TimeConstants { roll, pitch, yaw, thrust: lag } = &mut v.time_constant_s;
        let MaxRates { roll: most_roll, pitch: most_pitch, yaw: most_yaw } = &mut v.max_rate_deg_s;
        let axes = [(roll, most_roll), (pitch, most_pitch), (yaw, most_yaw)];
        for (axis, (lag, most)) in axes.into_iter().enumerate() {
            let Ok(fit) = &self.rates[axis] else { continue };
            if kept.lag[axis] {
                *lag = fit.values[0];
            }
            if kept.rate[axis] {
                *most = (fit.values[1] * full_rate[axis]).to_degrees();
                sensors.gyro_rad_s[axis] = fit.values[2];
            }
        }
        self.extend(&mut v.effects, kept);
        if let Ok(fit) = &self.battery {
            let pack = battery::pack(data, part, fit, &start.battery);
            if kept.volts {
                v.battery = pack;
            }
            if !kept.discharge {
                // As fast as the base vehicle's pack, in its share of the voltage.
                v.battery.rate_v_s = start.battery.rate_v_s * v.battery.full_v / start.battery.full_v;
            }
        }
        if let Ok(fit) = &self.thrust {
            if kept.lag[3] {
                *lag = fit.solution.values[TAU];
            }
            if kept.thrust {
                v.thrust_n = std::array::from_fn(|k| fit.solution.values[THRUST + k] * start.mass_kg);
                let [x, y] = [0, 1].map(|k| fit.solution.values[OFFSET + k]);
                sensors.accelerometer_m_s2 = [x, y, self.bias.as_ref().map_or(0.0, |b| b.values[2])];
            }
            if kept.drag {
                let k = std::array::from_fn(|k| fit.solution.values[DRAG_AT + k] * start.mass_kg);
                v.drag.semi_axes_m = semi_axes(k, start.drag.coefficient, start.drag.air_density_kg_m3);
            }
            if let Some(identified) = &mut v.identified
                && kept.thrust
            {
                identified.thrust_from = fit.source;
                identified.rotors = fit.chain;
                if let Some(chain) = &mut identified.rotors
                    && let Some(k) = &mut chain.thrust_n_per_speed_squared
                {
                    *k *= start.mass_kg;
                }
            }
        }
        if let Some(identified) = &mut v.identified {
            identified.sensors = Some(sensors);
        }
        v
    }
}
