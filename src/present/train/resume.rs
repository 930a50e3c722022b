//! Going on with a training that was stopped or killed.

use super::{Ended, TrainingWatch, file_of, go_on};
use crate::base::check::BadInput;
use crate::base::error::Result;
use crate::base::fsio;
use crate::base::lane::Level;
use crate::model::track::Track;
use crate::model::vehicle::Vehicle;
use crate::present::run::checkpoints::{CHECKPOINTS, Checkpoints, Note};
use crate::present::run::provenance::Provenance;
use crate::present::run::{POLICY, Run, SNAPSHOTS, live};
use crate::race::config::{Config, Setup};
use crate::race::train::race;
use std::path::Path;

/// Goes on with the training in `folder` from its last checkpoint, as if it had never stopped; from the beginning where
/// there is none yet. `None` of a training that is finished.
pub fn resume(folder: &Path, threads: usize, watch: &mut dyn TrainingWatch) -> Result<Option<Ended>> {
    let run = Run { folder: folder.into() };
    let setup = setup_of(folder)?;
    if folder.join(POLICY).is_file() && !folder.join(CHECKPOINTS).is_dir() {
        return Ok(None);
    }
    super::room::check(&setup)?;
    let checkpoints = Checkpoints::claim(&run, &setup)?;
    for place in [folder.to_path_buf(), folder.join(SNAPSHOTS), folder.join(CHECKPOINTS)] {
        fsio::remove_leftovers(&place);
    }
    let found = checkpoints.find(&race(&setup), &|note| fits(&run, note));
    let provenance = Provenance::now(Level::best(), threads);
    watch.begin(&run, &setup, &provenance);
    for why in &found.refused {
        watch.remark(&format!("warning: a checkpoint is not used: {why}"));
    }
    let steps = found.state.as_ref().map_or(0, |state| state.steps);
    watch.remark(&match steps {
        0 => "no checkpoint: trained from the beginning".to_string(),
        steps => format!("going on after {:.1} M steps", steps as f64 / 1e6),
    });
    checkpoints.forget_after(steps);
    forget_policies(&run, &found.note);
    go_on(&run, &setup, threads, checkpoints, found, watch).map(Some)
}

/// What the run in `folder` was trained as.
fn setup_of(folder: &Path) -> Result<Setup, BadInput> {
    let file = |name: &str| {
        let path = folder.join(name);
        match path.is_file() {
            true => Ok(path.display().to_string()),
            false => {
                let advice = "give the folder of a training that was stopped or killed";
                Err(BadInput::new(folder.display(), format!("no {name} in it"), "the folder of a run", advice))
            }
        }
    };
    Ok(Setup {
        config: Config::load(&file("config.toml")?, &[])?,
        track: Track::load(&file("track.toml")?)?,
        vehicle: Vehicle::load(&file("vehicle.toml")?)?,
    })
}

/// Whether all that `note` counts on is there.
fn fits(run: &Run, note: &Note) -> Result<(), String> {
    let lengths = live::lengths(run);
    if lengths.metrics < note.logs.metrics || lengths.events < note.logs.events {
        return Err("the logs have lost rows that were there when it was made".into());
    }
    let lost = note.taken.iter().map(|taken| file_of(taken.steps)).find(|name| !run.folder.join(name).is_file());
    lost.map_or(Ok(()), |name| Err(format!("{name} is gone")))
}

/// Removes the policies that were taken after the checkpoint: they are taken again.
fn forget_policies(run: &Run, note: &Note) {
    let known: Vec<_> = note.taken.iter().map(|taken| run.folder.join(file_of(taken.steps))).collect();
    let there = std::fs::read_dir(run.folder.join(SNAPSHOTS)).into_iter().flatten().flatten().map(|entry| entry.path());
    there.filter(|path| !known.contains(path)).for_each(|path| drop(std::fs::remove_file(path)));
}
