//! The runs that a study still lacks, as an array job of Slurm: a task for each run.

use crate::base::check::BadInput;
use crate::base::fsio;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Folder, in the study's, of the script, of what the tasks print, and of the job's number.
const FOLDER: &str = "slurm";
const JOB: &str = "job";

/// Where and how long tasks run; what is not given is left to the cluster.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct SlurmArgs {
    /// Submit the runs that are still to do as an array job, a task a run, and return
    #[arg(long, conflicts_with_all = ["shard", "jobs", "list", "table", "json"])]
    slurm: bool,
    /// Partition of the cluster
    #[arg(long, value_name = "NAME", requires = "slurm")]
    partition: Option<String>,
    /// Longest time of a task, as `sbatch` takes it: MINUTES, HH:MM:SS or DAYS-HH
    #[arg(long, value_name = "TIME", requires = "slurm")]
    time: Option<String>,
}

impl SlurmArgs {
    pub fn asked(&self) -> bool {
        self.slurm
    }
}

/// What a task does.
pub struct Tasks<'a> {
    /// Places of the runs that are to do, counted from 1.
    pub runs: &'a [usize],
    /// Runs of the whole study.
    pub of: usize,
    /// Processors of a task.
    pub threads: usize,
    /// Arguments of `racer study`, without those of the shard and its processors.
    pub command: Vec<String>,
}

/// Submits them for the study in `out`; the job's number. Refuses while an earlier job of the study is under way.
pub fn submit(out: &Path, args: &SlurmArgs, tasks: &Tasks) -> anyhow::Result<String> {
    if let Some((job, states)) = under_way(out) {
        let advice = format!("wait for it, or end it with: scancel {job}");
        return Err(BadInput::new("--slurm", format!("job {job}, {states}"), "no job of this study", &advice).into());
    }
    let folder = std::path::absolute(out)?.join(FOLDER);
    std::fs::create_dir_all(&folder)?;
    let path = folder.join("study.sbatch");
    let program = std::env::current_exe()?.display().to_string();
    fsio::replace(&path, script(&program, &folder, args, tasks).as_bytes())?;
    let output = sbatch(&path)?;
    let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_string();
    if !output.status.success() {
        let advice = "see the partitions with sinfo, or submit the script by hand";
        return Err(BadInput::new(path.display(), said(&output.stderr), "a script that sbatch takes", advice).into());
    }
    // `--parsable` prints NUMBER or NUMBER;CLUSTER.
    let job = said(&output.stdout).split(';').next().unwrap_or_default().to_string();
    fsio::replace(&folder.join(JOB), job.as_bytes())?;
    Ok(job)
}

fn sbatch(script: &Path) -> Result<Output, BadInput> {
    Command::new("sbatch").arg("--parsable").arg(script).output().map_err(|error| {
        BadInput::new("--slurm", format!("sbatch: {error}"), "Slurm on this machine", "use --shard without Slurm")
    })
}

/// The study's last job and how many of its tasks are in which state; none where it is over, or Slurm does not say.
pub fn under_way(out: &Path) -> Option<(String, String)> {
    let job = std::fs::read_to_string(out.join(FOLDER).join(JOB)).ok()?;
    let output = Command::new("squeue").args(["-h", "-r", "-o", "%T", "-j", &job]).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut states: Vec<_> = text.lines().map(|line| line.trim().to_lowercase()).filter(|l| !l.is_empty()).collect();
    states.sort();
    let counts = states.chunk_by(|a, b| a == b).map(|same| format!("{} {}", same.len(), same[0]));
    let counts: Vec<_> = counts.collect();
    (!counts.is_empty()).then(|| (job, counts.join(", ")))
}

/// What a task printed, `K` being its run's place from 1.
pub fn prints(out: &Path) -> PathBuf {
    out.join(FOLDER).join("task-K.log")
}

/// The script. Slurm begins tasks of a failed node again (`--requeue`).
fn script(program: &str, folder: &Path, args: &SlurmArgs, tasks: &Tasks) -> String {
    let mut text = String::from("#!/bin/bash\n");
    let mut option = |name: &str, value: &str| text.push_str(&format!("#SBATCH --{name}={value}\n"));
    option("job-name", "racer-study");
    option("array", &ranges(tasks.runs));
    option("cpus-per-task", &tasks.threads.to_string());
    option("output", &quoted(&folder.join("task-%a.log").display().to_string()));
    for (name, value) in [("partition", &args.partition), ("time", &args.time)] {
        if let Some(value) = value {
            option(name, &quoted(value));
        }
    }
    let command: Vec<_> =
        std::iter::once(program).chain(tasks.command.iter().map(String::as_str)).map(quoted).collect();
    let shard = format!("--threads \"$SLURM_CPUS_PER_TASK\" --shard \"$SLURM_ARRAY_TASK_ID/{}\"", tasks.of);
    let _ = writeln!(text, "#SBATCH --requeue\n#SBATCH --open-mode=append\n{} {shard}", command.join(" "));
    text
}

/// `1-3,7`.
fn ranges(places: &[usize]) -> String {
    let runs = places.chunk_by(|a, b| a + 1 == *b).map(|run| match run {
        [one] => one.to_string(),
        _ => format!("{}-{}", run[0], run[run.len() - 1]),
    });
    runs.collect::<Vec<_>>().join(",")
}

/// As one word of a shell.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', r"'\''"))
}

// Slurm is of Unix only, and so are its paths.
#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_task_makes_the_run_of_its_number() {
        let command = vec!["study".to_string(), "it's".to_string()];
        let tasks = Tasks { runs: &[1, 2, 3, 7, 9, 10], of: 12, threads: 4, command };
        let args = SlurmArgs { partition: Some("long".into()), ..Default::default() };
        let text = script("/bin/racer", Path::new("/out/slurm"), &args, &tasks);
        for line in [
            "#SBATCH --array=1-3,7,9-10",
            "#SBATCH --cpus-per-task=4",
            "#SBATCH --partition='long'",
            "#SBATCH --output='/out/slurm/task-%a.log'",
            r#"'/bin/racer' 'study' 'it'\''s' --threads "$SLURM_CPUS_PER_TASK" --shard "$SLURM_ARRAY_TASK_ID/12""#,
        ] {
            assert!(text.lines().any(|found| found == line), "no {line} in\n{text}");
        }
        assert!(!text.contains("--time"));
    }
}
