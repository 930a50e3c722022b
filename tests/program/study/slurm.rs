//! `racer study --slurm` with stand-ins for Slurm's programs; `.ci/slurm-try` does it with Slurm itself.

use super::{TINY, runs, tables, with_study};
use crate::support::{Ran, racer};
use assert_cmd::Command;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

/// Runs each task of the array but those of the file `skipped`, one after the other, and says that it is job 17.
const SBATCH: &str = r#"#!/bin/bash
list=$(sed -n 's/^#SBATCH --array=//p' "$2")
export SLURM_CPUS_PER_TASK=1
for part in ${list//,/ }; do
    for SLURM_ARRAY_TASK_ID in $(seq ${part%-*} ${part#*-}); do
        export SLURM_ARRAY_TASK_ID
        grep -qx $SLURM_ARRAY_TASK_ID skipped || bash "$2" >>tasks.log 2>&1
    done
done
echo "17;cluster"
"#;
/// Prints the file `queue`.
const SQUEUE: &str = "#!/bin/bash\ncat queue\n";

fn study(folder: &Path, options: &[&str]) -> Ran {
    let path = format!("{}:{}", folder.display(), std::env::var("PATH").unwrap());
    let mut command = Command::cargo_bin("racer").unwrap();
    Ran::of(command.current_dir(folder).env("PATH", path).args(["study", "tiny.toml"]).args(options))
}

#[test]
fn a_study_is_submitted_and_what_failed_again() {
    let folder = with_study(TINY);
    let at = folder.path();
    let refused = racer(at, &["study", "tiny.toml", "--partition", "long"]);
    assert!(refused.code == 2 && refused.err.contains("--slurm"), "{}", refused.err);
    for (name, text) in [("sbatch", SBATCH), ("squeue", SQUEUE), ("skipped", "2\n"), ("queue", "")] {
        std::fs::write(at.join(name), text).unwrap();
        std::fs::set_permissions(at.join(name), std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    assert_eq!(racer(at, &["study", "tiny.toml", "--out", "alone"]).code, 0);

    let first = study(at, &["--slurm", "--threads", "1"]);
    assert!(first.code == 0 && first.err.contains("job 17: 4 of 4 runs"), "{}", first.err);
    let out = at.join("runs/tiny");
    assert_eq!(runs(&out).len(), 3, "{}", std::fs::read_to_string(at.join("tasks.log")).unwrap());

    std::fs::write(at.join("queue"), "RUNNING\nPENDING\nPENDING\n").unwrap();
    let table = study(at, &["--table"]);
    assert!(table.err.contains("3 of 4 runs") && table.err.contains("job 17 of Slurm: 2 pending, 1 running"));
    let busy = study(at, &["--slurm"]);
    assert!(busy.code == 2 && busy.err.contains("scancel 17"), "{}", busy.err);

    std::fs::write(at.join("queue"), "").unwrap();
    std::fs::write(at.join("skipped"), "").unwrap();
    let second = study(at, &["--slurm", "--threads", "1"]);
    assert!(second.err.contains("job 17: 1 of 4 runs"), "{}", second.err);
    assert_eq!(tables(&out), tables(&at.join("alone")));
    let idle = study(at, &["--slurm"]);
    assert!(idle.code == 0 && idle.err.contains("nothing to submit"), "{}", idle.err);

    std::fs::remove_file(at.join("sbatch")).unwrap();
    std::fs::remove_dir_all(&out).unwrap();
    let missing = study(at, &["--slurm"]);
    let expected = std::process::Command::new("sbatch").arg("--version").output().is_err();
    assert!(!expected || (missing.code == 2 && missing.err.contains("--shard")), "{}", missing.err);
}
