//! The way of a command from the stick to the controller: backlash, loss, delay.

use crate::truth::effects::terms::Terms;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rand_distr::Exp1;
use std::collections::VecDeque;

/// Oldest command that may still be asked for, s.
const MEMORY_S: f64 = 0.05;

/// Commands and when they arrive.
#[derive(Debug)]
pub struct Link {
    /// Roll and pitch.
    rates: VecDeque<(f64, [f64; 2])>,
    yaw: VecDeque<(f64, f64)>,
    thrust: VecDeque<(f64, f64)>,
    /// Of roll and pitch, yaw, and thrust, s.
    delays: [f64; 3],
    jitter: f64,
    dropout: f64,
    /// Half widths of the backlash of yaw and thrust, and where their far ends stand.
    play: [f64; 2],
    stands: [f64; 2],
    rng: StdRng,
}

impl Link {
    pub fn new(terms: &Terms, seed: u64) -> Self {
        Link {
            rates: VecDeque::from([(f64::NEG_INFINITY, [0.0; 2])]),
            yaw: VecDeque::from([(f64::NEG_INFINITY, 0.0)]),
            thrust: VecDeque::from([(f64::NEG_INFINITY, -1.0)]),
            delays: [terms.rate_delay, terms.rate_delay + terms.yaw_delay, terms.thrust_delay],
            jitter: terms.jitter,
            dropout: terms.dropout,
            play: [terms.yaw_play, terms.throttle_play],
            stands: [0.0, -1.0],
            rng: StdRng::seed_from_u64(seed ^ 0x11_4b),
        }
    }

    /// A command is sent, which may be lost.
    pub fn send(&mut self, time: f64, command: [f64; 4]) {
        let [roll, pitch, yaw, thrust] = command;
        let lost = self.rng.random::<f64>() < self.dropout;
        let late = self.jitter * self.rng.sample::<f64, _>(Exp1);
        self.forget(time - MEMORY_S);
        if lost {
            return;
        }
        for (k, command) in [yaw, thrust].into_iter().enumerate() {
            self.stands[k] = self.stands[k].clamp(command - self.play[k], command + self.play[k]);
        }
        let [yaw, thrust] = self.stands;
        // No command overtakes the one before.
        let arrives = (time + self.delays[0] + late).max(self.rates.back().map_or(time, |last| last.0));
        self.rates.push_back((arrives, [roll, pitch]));
        self.yaw.push_back((arrives + self.delays[1] - self.delays[0], yaw));
        self.thrust.push_back((time + self.delays[2], thrust));
    }

    fn forget(&mut self, before: f64) {
        while self.rates.get(1).is_some_and(|next| next.0 < before) {
            self.rates.pop_front();
        }
        while self.yaw.get(1).is_some_and(|next| next.0 < before) {
            self.yaw.pop_front();
        }
        while self.thrust.get(1).is_some_and(|next| next.0 < before) {
            self.thrust.pop_front();
        }
    }

    /// The command that acts at `time`.
    pub fn at(&self, time: f64) -> [f64; 4] {
        let [x, y] = latest(&self.rates, time).unwrap_or([0.0; 2]);
        [x, y, latest(&self.yaw, time).unwrap_or(0.0), latest(&self.thrust, time).unwrap_or(-1.0)]
    }

    /// The newest command, whether it has arrived or not.
    pub fn newest(&self) -> [f64; 4] {
        let [x, y] = self.rates.back().map_or([0.0; 2], |sent| sent.1);
        [x, y, self.yaw.back().map_or(0.0, |sent| sent.1), self.thrust.back().map_or(-1.0, |sent| sent.1)]
    }

    /// When the next command arrives after `time` and before `end`, if one does.
    pub fn next_edge(&self, time: f64, end: f64) -> Option<f64> {
        let edges = self.rates.iter().map(|c| c.0).chain(self.yaw.iter().map(|c| c.0));
        let edges = edges.chain(self.thrust.iter().map(|c| c.0));
        // Nearer than a nanosecond is the rounding of times.
        edges.filter(|edge| *edge > time + 1e-9 && *edge < end - 1e-9).min_by(f64::total_cmp)
    }
}

fn latest<T: Copy>(queue: &VecDeque<(f64, T)>, time: f64) -> Option<T> {
    queue.iter().rev().find(|(arrives, _)| *arrives <= time + 1e-9).map(|(_, command)| *command)
}
