//! The extended vehicle of a log: whether there is one, whether it trains, and what it predicts of a flight that
//! nothing has seen.

use crate::args::Args;
use crate::judge::Judged;
use crate::run::{self, VEHICLE};
use crate::truth::hidden::Setting;
use racer::flight::Log;
use serde_json::Value;
use std::path::Path;

/// Name of the extended vehicle in the folder of a log.
pub const EXTENDED: &str = "extended.toml";
const UNSEEN: &str = "unseen.mcap";
/// Length of the flight that nothing has seen, s.
const UNSEEN_S: f64 = 60.0;
/// As much of a training as shows that the vehicle can be flown.
const TRAIN: &str = "train --vehicle extended.toml --steps 40000 --out run --threads 1 --set eval.agents=4 \
    --set budget.snapshots=1 --set ppo.environments=64 --set ppo.rollout=16 --set ppo.minibatches=2";

#[derive(Clone, Debug)]
pub struct Extended {
    pub trains: bool,
    /// Signals of the unseen flight, and the error of the extended vehicle over that of the base, by size.
    pub ratios: Vec<(String, f64)>,
    /// Those that are worse beyond chance, as `racer predict` tells it.
    pub surely_worse: Vec<(String, f64)>,
}

impl Extended {
    /// What became of the vehicle that the program wrote into `folder` of a flight of `setting`; none where it wrote
    /// none. The other flight is flown by `fly`, and only for a vehicle.
    pub fn of(
        args: &Args,
        folder: &Path,
        setting: &Setting,
        fly: impl FnOnce(&Setting) -> Log,
    ) -> Option<Result<Self, String>> {
        let unseen = Setting { seed: setting.seed ^ 1, seconds: UNSEEN_S, ..*setting };
        folder.join(EXTENDED).exists().then(|| Self::tried(args, folder, &fly(&unseen)))
    }

    fn tried(args: &Args, folder: &Path, unseen: &Log) -> Result<Self, String> {
        let _ = std::fs::remove_dir_all(folder.join("run"));
        let trains = run::run(args, folder, &TRAIN.split_whitespace().collect::<Vec<_>>()).is_ok();
        let bytes = racer::flight::write::mcap(unseen).map_err(|error| error.to_string())?;
        std::fs::write(folder.join(UNSEEN), bytes).map_err(|error| error.to_string())?;
        let asked = ["predict", UNSEEN, "--vehicle", VEHICLE, "--vehicle", EXTENDED, "--json"];
        let said: Value = serde_json::from_str(&run::said(args, folder, &asked)?).map_err(|error| error.to_string())?;
        let channels = said["channels"].as_array().ok_or("a prediction without channels")?;
        let ratio =
            |channel: &Value| Some((channel["name"].as_str()?.to_string(), 1.0 + channel["change"][0]["by"].as_f64()?));
        let sure = |channel: &&Value| channel["change"][0]["low"].as_f64().is_some_and(|low| low > 0.0);
        let sorted = |mut of: Vec<(String, f64)>| {
            of.sort_by(|a, b| a.1.total_cmp(&b.1));
            of
        };
        let ratios = sorted(channels.iter().filter_map(ratio).collect());
        let surely_worse = sorted(channels.iter().filter(sure).filter_map(ratio).collect());
        Ok(Self { trains, ratios, surely_worse })
    }
}

/// Whether there is one, else why not; whether it trains; what it predicts best and worst, and worst
/// of what is worse beyond chance.
pub fn fields(judged: &Judged) -> Vec<String> {
    let why = judged.answer.as_ref().ok().and_then(|answer| answer.not_extended.clone());
    let mut fields = match &judged.extended {
        None => vec![why.unwrap_or_default()],
        Some(Err(error)) => vec![format!("FAILED {error}")],
        Some(Ok(of)) => {
            let ends = [of.ratios.first(), of.ratios.last(), of.surely_worse.last()].into_iter().flatten();
            let ends = ends.flat_map(|(name, ratio)| [name.clone(), format!("{ratio:.4}")]);
            ["1".to_string(), usize::from(of.trains).to_string()].into_iter().chain(ends).collect()
        }
    };
    fields.resize(8, String::new());
    fields
}
