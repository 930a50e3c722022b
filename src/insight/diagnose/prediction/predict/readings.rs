//! What gyro and accelerometer read of a predicted flight, averaged over bins.

use super::Predicted;
use crate::base::lane::build;
use crate::insight::diagnose::prediction::actuator_response::supplied;
use crate::insight::diagnose::prediction::bends;
use crate::insight::diagnose::prediction::forms::TAPS_S;
use crate::insight::diagnose::prediction::imu_seen::slopes;
use crate::insight::diagnose::prediction::model::Model;
use crate::insight::diagnose::prediction::record::FlightRecord;
use crate::model::dynamics::extended::{self, Extended};
use crate::model::effects::{Card, Quantities, Quantity, Sensed};

impl Predicted {
    /// Readings, averaged over bins.
    #[inline(always)]
    pub(super) fn sense(
        &mut self,
        p: &Extended<f64>,
        dirty: Quantities,
        model: &Model,
        record: &FlightRecord,
        x: &[f64],
    ) {
        let k = model.sensors(x);
        let turning = |card: &&Card| card.reads.contains(&Quantity::AngularAcceleration);
        let acceleration = if model.present(x).iter().any(turning) {
            self.turning(p, record)
        } else {
            vec![[0.0; 3]; record.time.len()]
        };
        let known =
            |c: usize| if c < 3 { record.commanded[0] } else { record.commanded[1] && (record.moves || c == 5) };
        let wanted = |c: usize| known(c) && dirty.has(if c < 3 { Quantity::Gyro } else { Quantity::Accelerometer });
        let bent = bends::taps(x).map(|taps| self.bent_rates(record, &taps));
        let mut means: [Vec<f64>; 6] = Default::default();
        for &[from, to] in &record.bins {
            let mut sum = [0.0; 6];
            for i in from..to {
                let throttle = extended::throttle(self.command[i][3]);
                let (rates, force) = (self.rates[i], self.force[i]);
                let mut sensed = Sensed { rates, acceleration: acceleration[i], force, throttle };
                k.sense(&mut sensed);
                for j in 0..3 {
                    // The gyro's own lateness, on top of what the sensor makes of it.
                    sum[j] += sensed.rates[j] - rates[j] + self.seen_rates[i][j];
                    sum[j] += bent.as_ref().map_or(0.0, |bent| bent[i][j]);
                    sum[3 + j] += sensed.force[j];
                }
            }
            (0..6).filter(|&c| wanted(c)).for_each(|c| means[c].push(sum[c] / (to - from) as f64));
        }
        for (c, mean) in means.into_iter().enumerate() {
            if wanted(c) {
                self.channels[c] = mean.into();
            }
        }
    }

    /// What the response has beside a lag and a delay: the rates' changes of a moment ago, by `taps`.
    fn bent_rates(&self, record: &FlightRecord, taps: &[[f64; TAPS_S.len()]; 3]) -> Vec<[f64; 3]> {
        let slope = slopes(&record.time, &self.seen_rates);
        let before = TAPS_S.map(|tap| (tap / record.period_s).round() as usize);
        let known = |i: usize, k: usize| if slope[i][k].is_finite() { slope[i][k] } else { 0.0 };
        let bent = |i: usize, k: usize| {
            (0..TAPS_S.len()).map(|j| taps[k][j] * known(i.saturating_sub(before[j]), k)).sum::<f64>()
        };
        (0..slope.len()).map(|i| std::array::from_fn(|k| bent(i, k))).collect()
    }

    /// Angular acceleration, rad/s2: what the response does at each moment, for it is over in a few samples.
    #[inline(always)]
    fn turning(&self, p: &Extended<f64>, record: &FlightRecord) -> Vec<[f64; 3]> {
        const MOMENT_S: f64 = 1e-5;
        if !record.commanded[0] {
            return slopes(&record.time, &self.rates);
        }
        let mut out = Vec::with_capacity(record.time.len());
        for i in 0..record.time.len() {
            let (sent, slope) = self.setpoint[i];
            let voltage = supplied(p, record, i);
            let (next, _) = extended::actuator_response(p, self.command[i], slope, sent, voltage, MOMENT_S);
            let (now, next) = (extended::body_rates(p, self.command[i]), extended::body_rates(p, next));
            out.push(build!(|k| (next[k] - now[k]) / MOMENT_S));
        }
        out
    }
}
