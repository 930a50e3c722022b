//! Exports, in the hands of those who use them: compilers of C, an emulated board, Python.
//!
//! Where a compiler, QEMU or Python is missing, a test says so and passes, unless `RACER_REQUIRE_COMPILERS` or
//! `RACER_REQUIRE_PYTHON` is set.

use crate::support::{python, skipped};
use racer::present::export::{ExportFormat, Exported};
use racer::race::snapshot::Snapshot;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

const POLICY: &str = "tests/golden/policy-73e7003.safetensors";
/// What it says of the square's lap, by `racer eval --start fixed --agents 1` at 73e7003, s.
const LAP_S: f64 = 1.784_142;
/// Instructions that a step may take on a Cortex-M, and bytes of the policy without its self-test.
const MOST_INSTRUCTIONS: u64 = 45_000;
const MOST_BYTES: u64 = 34_000;

const STRICT: [&str; 6] = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror"];
const SOURCES: [&str; 4] = ["racer_policy.c", "racer_policy_data.c", "racer_self_test.c", "racer_self_test_data.c"];

/// An export of the golden policy in a folder of its own.
fn exported(format: ExportFormat) -> TempDir {
    let bytes = std::fs::read(POLICY).unwrap();
    let exported = Exported::new(Snapshot::read(Path::new(POLICY)).unwrap(), &bytes).unwrap();
    let folder = TempDir::new().unwrap();
    for (name, bytes) in exported.files(format).unwrap() {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    folder
}

fn there(tool: &str) -> bool {
    let found = Command::new(tool).arg("--version").output().is_ok_and(|output| output.status.success());
    if !found {
        skipped(tool, "RACER_REQUIRE_COMPILERS");
    }
    found
}

/// What `command` prints; it has to succeed.
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{err}");
    String::from_utf8_lossy(&output.stdout).into_owned() + &err
}

fn board(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/board").join(name)
}

/// Builds `main` with the sources of the export, and runs it.
fn host(compiler: &str, options: &[&str], folder: &Path, main: &Path) -> String {
    let program = folder.join(format!("program-{compiler}"));
    let mut command = Command::new(compiler);
    command.current_dir(folder).args(STRICT).args(options).arg("-I.").args(SOURCES).arg(main);
    printed(command.arg("-o").arg(&program));
    printed(&mut Command::new(program))
}

#[test]
fn c_compiles_without_a_warning_and_passes_its_self_test() {
    for compiler in ["gcc", "clang"] {
        if !there(compiler) {
            continue;
        }
        let folder = exported(ExportFormat::C);
        let sane = ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
        let out = host(compiler, &sane, folder.path(), &board("host.c"));
        assert!(out.contains("recorded flags 0 fine 1") && out.contains("self_test 0"), "{out}");
        for bad in ["not_a_number", "infinite", "huge", "no_attitude"] {
            // Level rates, and the thrust that carries the vehicle.
            assert!(out.contains(&format!("{bad} flags 8 fine 1 still 1 weight 1.00")), "{out}");
        }
        assert!(out.contains("far_away flags 4 fine 1") && out.contains("beside missed 1 target 0"), "{out}");
        let loops = folder.path().join("examples/bare_loop.c");
        assert!(host(compiler, &["-O2"], folder.path(), &loops).contains("self-test 0"));
        for example in ["betaflight_task.c", "crazyflie_controller.c"] {
            let path = folder.path().join("examples").join(example);
            printed(Command::new(compiler).current_dir(folder.path()).args(STRICT).args(["-I.", "-c"]).arg(path));
        }
    }
}

/// A number of the policy, of a gate or of the filter that is another than it was is noticed.
#[test]
fn the_self_test_of_an_export_can_fail() {
    if !there("gcc") {
        return;
    }
    for name in ["racer_weight_1", "racer_bias_2", "racer_gates", "racer_scale", "racer_share", "racer_full_rate"] {
        let folder = exported(ExportFormat::C);
        let path = folder.path().join("racer_policy_data.c");
        let text = std::fs::read_to_string(&path).unwrap();
        let at = text.find(name).unwrap_or_else(|| panic!("no {name}"));
        let comma = at + text[at..].find(',').unwrap();
        // The second number in place of the first.
        let first = text[..comma].rfind(['{', '\n']).unwrap() + 1;
        let changed = format!("{}1e1f{}", &text[..first], &text[comma..]);
        std::fs::write(&path, changed).unwrap();
        let out = host("gcc", &["-O1"], folder.path(), &board("host.c"));
        assert!(!out.contains("self_test 0"), "a changed {name} is not noticed");
    }
}

#[test]
fn c_runs_on_emulated_boards() {
    if !there("arm-none-eabi-gcc") || !there("qemu-system-arm") {
        return;
    }
    let folder = exported(ExportFormat::C);
    for (cpu, fpu, machine) in [("cortex-m4", "fpv4-sp-d16", "mps2-an386"), ("cortex-m7", "fpv5-sp-d16", "mps2-an500")]
    {
        let program = folder.path().join(cpu);
        let target = [format!("-mcpu={cpu}"), "-mthumb".into(), "-mfloat-abi=hard".into(), format!("-mfpu={fpu}")];
        let mut command = Command::new("arm-none-eabi-gcc");
        command.current_dir(folder.path()).args(STRICT).args(&target).args(["-O2", "-I.", "-nostartfiles"]);
        command.arg("-T").arg(board("board.ld")).args(SOURCES).arg(board("board.c"));
        printed(command.arg("-o").arg(&program));

        let mut emulator = Command::new("qemu-system-arm");
        emulator.args(["-machine", machine, "-icount", "shift=0", "-display", "none", "-monitor", "none"]);
        emulator.args(["-serial", "none", "-semihosting-config", "enable=on,target=native", "-kernel"]);
        let out = printed(emulator.arg(&program));
        assert!(out.starts_with("self-test 0 "), "{cpu}: {out}");
        let count: u64 = out.trim().rsplit(' ').next().unwrap().parse().unwrap();
        assert!((10_000..=MOST_INSTRUCTIONS).contains(&count), "{cpu}: {count} instructions a step");

        let objects = ["racer_policy", "racer_policy_data"].map(|name| {
            let object = folder.path().join(format!("{name}-{cpu}.o"));
            let mut command = Command::new("arm-none-eabi-gcc");
            command.current_dir(folder.path()).args(&target).args(["-std=c99", "-O2", "-I.", "-c", "-o"]);
            printed(command.arg(&object).arg(format!("{name}.c")));
            object
        });
        let sizes = printed(Command::new("arm-none-eabi-size").args(&objects));
        let bytes: u64 =
            sizes.lines().skip(1).map(|line| line.split_whitespace().nth(3).unwrap().parse::<u64>().unwrap()).sum();
        assert!(bytes <= MOST_BYTES, "{cpu}: {bytes} bytes\n{sizes}");
        println!("{cpu}: {count} instructions a step, {bytes} bytes");
    }
}

#[test]
fn python_flies_a_lap_from_the_file_alone() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("policy.safetensors");
    Snapshot::read(Path::new(POLICY)).unwrap().write(&path).unwrap();
    let args = [Path::new("tests/python/fly.py"), &path, Path::new("docs/policy.schema.json")];
    let Some(output) = python("numpy, jsonschema", &args) else { return };
    let flown: Value = serde_json::from_slice(&output).unwrap();
    let lap = flown["lap_s"].as_f64().expect("a lap");
    assert!((lap - LAP_S).abs() < 1e-3, "{lap} s in Python, {LAP_S} s in racer");
    let off: Vec<f64> = flown["self_test"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!(off[..3].iter().all(|&share| share < 1.0) && off[3] == 0.0, "{off:?}");
    let noticed = flown["noticed"].as_object().unwrap();
    assert!(noticed.len() >= 12 && noticed.values().all(|noticed| noticed == true), "{noticed:?}");
    assert_eq!(flown["invalid"], Value::Array(vec![]), "docs/policy.schema.json is another");
}

#[test]
fn onnx_answers_as_the_policy_does() {
    let (model, document) = (exported(ExportFormat::Onnx), exported(ExportFormat::Json));
    let args = [
        Path::new("tests/python/onnx_policy.py"),
        &model.path().join("policy.onnx"),
        &document.path().join("policy.json"),
    ];
    let Some(output) = python("onnx, onnxruntime", &args) else { return };
    let told: Value = serde_json::from_slice(&output).unwrap();
    assert!(told["off"].as_f64().unwrap() < 1e-5 && told["one"].as_f64().unwrap() < 1e-6, "{told}");
    assert_eq!(told["same"], true, "the metadata is another");
}

#[test]
fn json_is_the_whole_file() {
    let folder = exported(ExportFormat::Json);
    let document: Value = serde_json::from_slice(&std::fs::read(folder.path().join("policy.json")).unwrap()).unwrap();
    assert_eq!(document["format"], "racer-policy-3");
    assert_eq!(document["sha256"].as_str().map(str::len), Some(64));
    assert_eq!(document["training"]["track"]["name"], "square");
    let weight = &document["tensors"]["actor.0.weight"];
    assert_eq!(weight["shape"], serde_json::json!([41, 64]));
    assert_eq!(weight["values"].as_array().unwrap().len(), 41 * 64);
    assert_eq!(
        document["tensors"]["self_test.target"]["values"][0],
        document["tensors"]["self_test.target"]["values"][1]
    );
}
