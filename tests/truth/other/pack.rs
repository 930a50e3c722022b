//! The pack: open circuit by charge, resistance, and cells that come back slowly.

use super::airframe::Airframe;
use super::faults::Faults;

#[derive(Clone, Copy, Debug)]
pub struct Pack {
    /// At the terminals, and as a speed controller sees them, V.
    pub volts: f64,
    pub seen: f64,
    /// Lost in a fast and a slow cell, V.
    lost: [f64; 2],
    /// Thrust over full thrust, summed over time, s.
    pub used: f64,
}

impl Pack {
    pub fn full(airframe: &Airframe) -> Self {
        Pack { volts: airframe.full_v, seen: airframe.full_v, lost: [0.0; 2], used: 0.0 }
    }

    /// After `dt` seconds at `share` of the full thrust; `time` since take-off.
    pub fn drained(&self, airframe: &Airframe, faults: &Faults, share: f64, time: f64, dt: f64) -> Self {
        let share = share.max(0.0);
        let spent = time / faults.seconds;
        let mut open = airframe.full_v + airframe.discharge * time;
        // Falls fast at first and then slowly, evenly downhill; or only at the end.
        open -= faults.of("ocv_bent") * (1.0 - (1.0 - spent).powi(3));
        open -= faults.of("ocv_knee") * (6.0 * (spent - 1.0)).exp();
        open -= faults.of("load_power") * share.powf(1.5);
        // Power over voltage: what sags draws more.
        let power = share.powf(1.25) * airframe.full_v / self.volts;
        open -= faults.of("load_electric") * power;
        let mut lost = self.lost;
        let cells = faults.of("slow_cells");
        for (lost, (part, tau)) in lost.iter_mut().zip([(0.5, 1.5), (0.5, 14.0)]) {
            *lost += (cells * part * share.powf(1.5) - *lost) * (1.0 - f64::exp(-dt / tau));
        }
        let volts = open - lost[0] - lost[1];
        let seen = self.seen + (volts - self.seen) * (1.0 - (-dt / 0.4).exp());
        Pack { volts, seen, lost, used: self.used + share * dt }
    }

    /// Volts that the motors behave as if they had.
    pub fn driving(&self, airframe: &Airframe, faults: &Faults) -> f64 {
        let made_up = faults.of("esc_voltage");
        self.volts * (airframe.full_v / self.seen).powf(made_up)
    }
}
