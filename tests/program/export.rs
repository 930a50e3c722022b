//! `racer export` as a user meets it, and files of policies that repeat.

use crate::support::racer;
use std::path::Path;

/// A policy of an older racer that laps the square.
fn golden() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/policy-73e7003.safetensors");
    path.to_str().unwrap().to_string()
}

#[test]
fn a_policy_is_exported_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    // What `sha256sum` says of the file.
    const SHA256: &str = "8e07bc963323206e9bc9903eb03b7f35abac052be5a1b63652019aa16313f060";
    for (format, name) in [("c", "racer_policy_data.h"), ("onnx", "policy.onnx"), ("json", "policy.json")] {
        let ran = racer(folder.path(), &["export", &golden(), "--format", format, "--out", format]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.out.contains(SHA256) && ran.out.contains("lap        1.784 s"), "{}", ran.out);
        let bytes = std::fs::read(folder.path().join(format).join(name)).unwrap();
        assert!(bytes.windows(64).any(|window| window == SHA256.as_bytes()), "{name} names no policy");
    }
    assert!(folder.path().join("c/examples/bare_loop.c").is_file());
}

#[test]
fn what_cannot_be_exported_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], says: &[&str]| {
        let ran = racer(folder.path(), &[&["export"], args].concat());
        assert_eq!(ran.code, 2, "{args:?}: {}", ran.err);
        says.iter().for_each(|text| assert!(ran.err.contains(text), "{args:?}: {}", ran.err));
    };
    refused(&[&golden(), "--format", "tflite"], &["tflite", "c, onnx, json"]);
    refused(&[&golden()], &["--format"]);
    refused(&["nothing", "--format", "c"], &["nothing of that name", "racer train"]);
    std::fs::create_dir(folder.path().join("run")).unwrap();
    refused(&["run", "--format", "c"], &["neither policy.safetensors nor snapshots"]);
    std::fs::create_dir(folder.path().join("full")).unwrap();
    std::fs::write(folder.path().join("full/mine.txt"), "mine").unwrap();
    refused(&[&golden(), "--format", "c", "--out", "full"], &["files in it", "nothing existing is overwritten"]);
    std::fs::write(folder.path().join("cut.safetensors"), &std::fs::read(golden()).unwrap()[..40_000]).unwrap();
    refused(&["cut.safetensors", "--format", "json"], &["cut.safetensors", "a policy snapshot"]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3, "nothing is left behind");
}

/// No time of day and no duration is in a policy's file.
#[test]
fn the_same_training_gives_the_same_files() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["one", "two"].map(|name| {
        let out = format!("--out={name}");
        let tiny = [
            "train",
            "--track=square",
            "--steps=4000",
            "--set=ppo.environments=64",
            "--set=ppo.rollout=16",
            "--set=ppo.minibatches=2",
            "--set=eval.agents=20",
            "--set=eval.max_steps=100",
            "--set=budget.snapshots=1",
            &out,
        ];
        let ran = racer(folder.path(), &tiny);
        assert_eq!(ran.code, 0, "{}", ran.err);
        std::fs::read(folder.path().join(name).join("policy.safetensors")).unwrap()
    });
    assert!(files[0] == files[1] && files[0].len() > 50_000);
}
