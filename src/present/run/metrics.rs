//! The training log: one row of named numbers an iteration.

use crate::base::check::BadInput;
use crate::base::encode;
use crate::base::error::Result;
use crate::base::stats;
use crate::learn::ppo::train::Iteration;
use crate::race::env::reward::TERMS;
use crate::race::env::tally::RaceTally;
use crate::race::env::terminate::CAUSES;
use std::path::Path;
use std::time::SystemTime;

/// Name of the file, in a run folder.
pub const METRICS: &str = "metrics.csv";

/// One iteration's numbers.
#[derive(Clone, Debug)]
pub struct LogRow {
    pub wall: SystemTime,
    pub steps: u64,
    /// Name and value; not a number where there was nothing to average over. Names are the same in every row.
    pub values: Vec<(String, f64)>,
}

impl LogRow {
    /// What `iteration` reports. `seconds` is how long it took.
    pub fn new(iteration: &Iteration<RaceTally>, seconds: f64) -> Self {
        let Iteration { tally, losses, .. } = iteration;
        let per_episode = |sum: f64| sum / tally.episodes();
        let returns: Vec<f64> = tally.returns.iter().copied().map(f64::from).collect();
        let mut values: Vec<(String, f64)> = [
            // Seconds of the budget used.
            ("time/seconds", iteration.seconds),
            // Environment steps a second over this iteration: 1e6 and more on two modern cores.
            ("time/steps_per_s", iteration.batch as f64 / seconds),
            // Over the episodes that ended in this iteration. Return and gates should rise to the end.
            ("episode/return_median", stats::quantile(&returns, 0.5)),
            ("episode/gates", per_episode(tally.episode_gates)),
            ("episode/steps", per_episode(tally.episode_steps)),
            ("episode/count", tally.episodes()),
            ("episode/laps", tally.laps),
            ("ppo/learning_rate", iteration.learning_rate),
            ("ppo/loss", losses.total),
            ("ppo/surrogate", losses.surrogate),
            ("ppo/value_loss", losses.value),
            ("ppo/entropy", losses.entropy),
            ("ppo/action_magnitude", losses.magnitude),
            // 0 where no mean command is beyond nine tenths of the stick.
            ("ppo/saturation", losses.saturation),
            // Healthy below about 0.02.
            ("ppo/approx_kl", losses.approx_kl),
            // Healthy at 0.05 to 0.3.
            ("ppo/clip_fraction", losses.clip_fraction),
            ("ppo/gradient_norm", losses.gradient_norm),
            // Rises towards 1 while the critic keeps up.
            ("ppo/explained_variance", iteration.explained_variance),
            // Of the advantages before they are normalised, in reward.
            ("ppo/advantage_std", iteration.advantage_std),
            // Should fall slowly; near 0 exploration has ended.
            ("ppo/action_std", iteration.std),
        ]
        .map(|(name, value)| (name.to_string(), value))
        .into();
        // Mean of each term a step; their sum is the reward.
        values.extend(TERMS.iter().zip(tally.terms).map(|(name, sum)| (format!("reward/{name}"), sum / tally.steps)));
        // Share of the ended episodes.
        values.extend(CAUSES.iter().zip(tally.causes).map(|(name, n)| (format!("ended/{name}"), per_episode(n))));
        values.push(("ended/horizon".into(), per_episode(tally.truncated)));
        Self { wall: SystemTime::now(), steps: iteration.steps, values }
    }

    /// The value called `name`, where it is a number.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|(known, _)| known == name).map(|(_, value)| *value).filter(|value| value.is_finite())
    }
}

/// Rows as CSV, with a header where one is asked for; cells without a number are empty.
pub fn to_csv(rows: &[LogRow], header: bool) -> Result<Vec<u8>> {
    let cell = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
    encode::csv("the log of the training", |csv| {
        if let (Some(first), true) = (rows.first(), header) {
            let names = first.values.iter().map(|(name, _)| name.clone());
            csv.write_record(["steps".to_string()].into_iter().chain(names))?;
        }
        rows.iter().try_for_each(|row| {
            let cells = row.values.iter().map(|(_, value)| cell(*value));
            csv.write_record([row.steps.to_string()].into_iter().chain(cells))
        })
    })
}

/// Columns of the CSV file at `path` by name, row by row; nothing where a cell is empty.
pub fn read<const N: usize>(path: &Path, names: [&str; N]) -> Result<Vec<[Option<f64>; N]>, BadInput> {
    read_where(path, names, true)
}

/// The same, with nothing in place of columns that are not there: those of an older racer's log may be fewer.
pub fn read_known<const N: usize>(path: &Path, names: [&str; N]) -> Result<Vec<[Option<f64>; N]>, BadInput> {
    read_where(path, names, false)
}

fn read_where<const N: usize>(path: &Path, names: [&str; N], all: bool) -> Result<Vec<[Option<f64>; N]>, BadInput> {
    let failed = |found: String| BadInput::new(path.display(), found, "the log of a training, metrics.csv", "");
    let text = std::fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
    // A training under way, or one that was killed or lost power, may end in half a row.
    let rows = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
    let mut csv = csv::Reader::from_reader(rows.as_bytes());
    let header = csv.headers().map_err(|error| failed(error.to_string()))?.clone();
    let mut places = [None; N];
    for (place, name) in places.iter_mut().zip(names) {
        *place = header.iter().position(|known| known == name);
        if place.is_none() && all {
            return Err(failed(format!("no column `{name}`")));
        }
    }
    let mut rows = Vec::new();
    for record in csv.records() {
        let record = record.map_err(|error| failed(error.to_string()))?;
        rows.push(places.map(|place| record.get(place?).and_then(|cell| cell.parse().ok())));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_is_read_as_it_was_written() {
        let values = vec![("a/b".to_string(), 1.5), ("c".to_string(), f64::NAN)];
        let row = LogRow { wall: SystemTime::UNIX_EPOCH, steps: 64, values };
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), to_csv(&[row], true).unwrap()).unwrap();
        assert_eq!(read(file.path(), ["c", "steps", "a/b"]).unwrap(), [[None, Some(64.0), Some(1.5)]]);
        assert!(read(file.path(), ["d"]).unwrap_err().to_string().contains("`d`"));
        assert_eq!(read_known(file.path(), ["d", "steps"]).unwrap(), [[None, Some(64.0)]]);
        std::fs::write(file.path(), "steps,c\n64,1\n128,2.").unwrap();
        assert_eq!(read(file.path(), ["c"]).unwrap(), [[Some(1.0)]], "half a row is none");
    }

    #[test]
    fn nothing_to_average_over_is_an_empty_cell() {
        let values = vec![("a/b".to_string(), 1.5), ("c".to_string(), f64::NAN)];
        let row = LogRow { wall: SystemTime::UNIX_EPOCH, steps: 64, values };
        assert_eq!(
            String::from_utf8(to_csv(std::slice::from_ref(&row), true).unwrap()).unwrap(),
            "steps,a/b,c\n64,1.5,\n"
        );
        assert_eq!((row.get("a/b"), row.get("c"), row.get("d")), (Some(1.5), None, None));
        assert!(to_csv(&[], true).unwrap().is_empty());
    }
}
