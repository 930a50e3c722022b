//! Several flights as one set of samples, split in time.

use super::flight::PreparedFlight;
use crate::flight::spans::length;
use crate::insight::quality::Quality;

/// Share of the usable samples, in the order of time, that the parameters are learned from before they are validated on
/// the rest (paper section 4.1).
pub const TRAIN_SHARE: f64 = 0.7;

/// Residuals of different stretches of time are taken for independent. Their length, s: longer than the noise
/// remembers, and so many stretches that their spread can be told.
const BLOCK_S: [f64; 2] = [0.3, 2.0];
const BLOCKS: f64 = 100.0;

/// Which samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataPart {
    /// The first 70 % of the usable samples.
    Train,
    /// The rest.
    Validation,
    /// All usable samples.
    All,
}

/// All flights, in the order given.
#[derive(Clone, Debug)]
pub struct Data {
    pub flights: Vec<PreparedFlight>,
    /// Number of usable samples before which the training part ends.
    cut: usize,
}

/// Samples chosen for a fit: of each flight, indices into its clock.
pub type Chosen = Vec<Vec<usize>>;

impl Data {
    pub fn new(logs: Vec<Quality>) -> Self {
        let usable: f64 = logs.iter().map(|log| length(&log.usable)).sum();
        let block_s = (usable / BLOCKS).clamp(BLOCK_S[0], BLOCK_S[1]);
        let mut first_block = 0;
        let mut flights = Vec::new();
        for quality in logs {
            let flight = PreparedFlight::new(quality, first_block, block_s);
            first_block = flight.block.last().map_or(first_block, |last| last + 1);
            flights.push(flight);
        }
        let usable: usize = flights.iter().map(|f| f.usable.iter().filter(|&&usable| usable).count()).sum();
        Self { flights, cut: (TRAIN_SHARE * usable as f64).round() as usize }
    }

    /// The usable samples of `part` for which `known(flight, sample)` holds.
    pub fn choose(&self, part: DataPart, known: impl Fn(usize, usize) -> bool) -> Chosen {
        let mut seen = 0;
        let mut chosen = vec![Vec::new(); self.flights.len()];
        for (f, flight) in self.flights.iter().enumerate() {
            for i in (0..flight.time.len()).filter(|&i| flight.usable[i]) {
                let train = seen < self.cut;
                seen += 1;
                let wanted = match part {
                    DataPart::Train => train,
                    DataPart::Validation => !train,
                    DataPart::All => true,
                };
                if wanted && known(f, i) {
                    chosen[f].push(i);
                }
            }
        }
        chosen
    }

    /// The chosen ones of signals that have a value for each sample of each flight.
    pub fn pick(signals: &[Vec<f64>], chosen: &Chosen) -> Vec<f64> {
        signals.iter().zip(chosen).flat_map(|(signal, chosen)| chosen.iter().map(|&i| signal[i])).collect()
    }

    /// Stretches of time of the chosen samples.
    pub fn blocks(&self, chosen: &Chosen) -> Vec<u32> {
        self.flights.iter().zip(chosen).flat_map(|(f, chosen)| chosen.iter().map(|&i| f.block[i])).collect()
    }

    /// A signal of every flight.
    pub fn signals(&self, of: impl Fn(&PreparedFlight) -> Vec<f64>) -> Vec<Vec<f64>> {
        self.flights.iter().map(of).collect()
    }

    /// Why no log can tell the parameter of this name; none where one can.
    pub fn why_not(&self, name: &str) -> Option<String> {
        let mut reasons = self.flights.iter().map(|flight| flight.quality.why_not(name));
        let first = reasons.next()?;
        if reasons.any(|reason| reason.is_none()) { None } else { first }
    }

    /// Usable flight, s.
    pub fn usable_s(&self) -> f64 {
        self.flights.iter().map(|flight| length(&flight.quality.usable)).sum()
    }
}
