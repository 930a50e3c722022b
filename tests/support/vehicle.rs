//! A simulated vehicle on a link, whatever it speaks: where it is, and how it flies.

use super::tongue::Told;
use racer::flight::live::Mission;
use racer::model::constants::CONTROL_S;
use racer::model::dynamics::{Craft, Factors, State};
use racer::race::onboard::{AT_START, Estimate};

/// The nominal vehicle on the pad.
pub struct Peer {
    craft: Craft<f32>,
    full: [f64; 3],
    pub now_s: f64,
}

impl Peer {
    pub fn new(mission: &Mission) -> Self {
        let start = mission.track.start;
        let (sin, cos) = (0.5 * start.heading_rad()).sin_cos();
        let attitude = [cos, 0.0, 0.0, sin];
        let state =
            State::new(start.position_m, [0.0; 3], attitude, AT_START.map(f64::from), mission.vehicle.battery.full_v);
        let craft = Craft::new(&mission.vehicle, &Factors::NOMINAL, CONTROL_S, state).map(|x| x as f32);
        Self { craft, full: mission.vehicle.max_rates_rad_s(), now_s: 0.0 }
    }

    pub fn told(&self, switch: bool) -> Told {
        let State { position, velocity, attitude, .. } = self.craft.state;
        let (body_rates, voltage) = (self.craft.body_rates(), self.craft.terminal_voltage());
        let estimate = Estimate { position, velocity, attitude, body_rates, voltage };
        // Its clock began elsewhere.
        Told { time_us: 77_000_000 + (self.now_s * 1e6).round() as u64, estimate, switch }
    }

    /// 10 ms under these body rates (rad/s) and this throttle. Without any it stays where it is.
    pub fn fly(&mut self, obeyed: Option<([f32; 3], f32)>) {
        if let Some((rates, throttle)) = obeyed {
            let [x, y, z] = std::array::from_fn(|i| rates[i] / self.full[i] as f32);
            self.craft.step([x, y, z, 2.0 * throttle - 1.0]);
        }
        self.now_s += CONTROL_S;
    }
}
