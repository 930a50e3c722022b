//! The files that a diagnosis can leave.

use super::Args;
use crate::base::check::BadInput;
use crate::base::encode;
use crate::base::fsio::{self, Reserved};
use crate::cli::{outputs, tell};
use crate::insight::diagnose::Diagnosed;
use crate::insight::diagnose::against::Changes;
use crate::insight::diagnose::judgement::diagnosis::Diagnosis;
use crate::insight::diagnose::judgement::finding::{Finding, Status};
use crate::insight::plan::NextFlight;
use crate::model::effects::Role;
use crate::present::report;
use crate::present::report::diagnosis::DiagnosisFigures;
use serde::Serialize;
use std::path::Path;

/// Those that were asked for, known to be writable before the work begins.
pub struct OutputFiles<'a> {
    json: Option<Reserved>,
    vehicle: Option<Reserved>,
    page: Option<Reserved>,
    figures: Option<&'a Path>,
    plan: Option<Reserved>,
}

impl<'a> OutputFiles<'a> {
    pub fn new(args: &'a Args) -> Result<Self, BadInput> {
        let files = [
            ("--json", args.json.as_deref()),
            ("--extend", args.extend.as_deref()),
            ("--report", args.report.as_deref()),
            ("--plan-out", args.plan_out.as_deref()),
        ];
        let figures = args.svg.as_deref();
        let trained = args.retrain.is_some().then_some(&*args.retrain_out);
        outputs::distinct(&[&files[..], &[("--svg", figures), ("--retrain-out", trained)]].concat())?;
        let [json, vehicle, page, plan] = outputs::reserve(files)?;
        figures.map(|folder| fsio::new_folder(folder, "--svg")).transpose()?;
        Ok(Self { json, vehicle, page, figures, plan })
    }

    /// Writes them; `next` is the planned flight, where one was asked for.
    pub fn write(self, diagnosed: &Diagnosed, next: Option<&NextFlight>) -> anyhow::Result<()> {
        show(diagnosed, self.page, self.figures)?;
        if let Some(json) = self.json {
            let (changes, diagnosis) = (diagnosed.changes.as_ref(), &diagnosed.diagnosis);
            let document = encode::json("the diagnosis", &DiagnosisFile { changes, plan: next, diagnosis })?;
            tell(&format!("figures in {}", json.write(document.as_bytes())?.display()));
        }
        if let Some((file, next)) = self.plan.zip(next) {
            match next.file() {
                Some(plan) => {
                    let written = file.write(encode::toml("the plan", &plan)?.as_bytes())?;
                    tell(&format!("plan in {0}: racer fly --pilot --plan {0}", written.display()));
                }
                None => tell("no plan is written: there is nothing to fly that tells more"),
            }
        }
        if let Some(file) = self.vehicle {
            let vehicle = super::extended(diagnosed, "--extend")?;
            let written = file.write(encode::toml("the vehicle", vehicle)?.as_bytes())?;
            tell(&format!("extended vehicle in {0}: racer train --vehicle {0}", written.display()));
            let is_wind = |f: &Finding| f.has(Role::UniformWind) && f.status != Status::Suspected;
            if diagnosed.diagnosis.findings.iter().any(is_wind) {
                tell("the wind is that day's, and not in it: `racer extend` adds one to train for");
            }
        }
        Ok(())
    }
}

/// The JSON file: what changed comes first.
#[derive(Serialize)]
struct DiagnosisFile<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    changes: Option<&'a Changes>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<&'a NextFlight>,
    #[serde(flatten)]
    diagnosis: &'a Diagnosis,
}

/// Page and figures, where they are asked for.
fn show(diagnosed: &Diagnosed, page: Option<Reserved>, folder: Option<&Path>) -> anyhow::Result<()> {
    if page.is_none() && folder.is_none() {
        return Ok(());
    }
    let figures = DiagnosisFigures::new(diagnosed)?;
    if let Some(folder) = folder {
        for figure in figures.all() {
            fsio::write_new(&folder.join(format!("{}.svg", figure.name)), figure.svg.as_bytes())?;
        }
        tell(&format!("{} figures in {}", figures.all().count(), folder.display()));
    }
    if let Some(page) = page {
        let written = page.write(report::diagnosis::page(diagnosed, &figures).as_bytes())?;
        tell(&format!("report in {}", written.display()));
    }
    Ok(())
}
