#!/usr/bin/env python3
"""Makes the measurements of RESULTS.md again, with today's build.

    python3 results/measure.py                     what there is, and which needs something that was not given
    python3 results/measure.py NAME... [--with KEY=VALUE...]
    python3 results/tables.py --write              afterwards: the tables of RESULTS.md

Trainings go on where they were left: what the CSV has already is not done again, delete its rows to begin anew. Build
first: `cargo build --release`. Times are of two cores.
"""

import argparse
import csv
import json
import pathlib
import shlex
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent
RUNS = ROOT / "runs"

BENCH = "cargo bench --bench hidden_effects --"
LOOP = "python3 tests/python/firmware_loop.py target/release/racer"
# Name: needs, about how long, and the command; a list of trainings is a command of its own.
COMMANDS = {
    "against": ([], "1.5 h", f"{BENCH} --against --n 100 --seconds 60 --seed 13 --jobs 2 --csv results/against.csv"),
    "plan": ([], "4 h", f"{BENCH} --plan --n 130 --seed 4 --jobs 2 --csv results/plan.csv"),
    "matched": ([], "2 h", f"{BENCH} --n 60 --seed 31 --tier matched --jobs 2"),
    "unmatched": ([], "0.5 h", f"{BENCH} --n 14 --seed 32 --tier unmatched --jobs 2"),
    "outside": ([], "0.5 h", f"{BENCH} --n 14 --seed 33 --tier outside --jobs 2"),
    "race": ([], "0.5 h", f"{BENCH} --n 12 --seed 34 --tier matched --style race --jobs 2"),
    "other": ([], "0.3 h", f"{BENCH} --tier other --n 16 --seed 8 --seconds 100 --jobs 2"),
    "retraining": ([], "0.5 h", "cargo bench --bench retraining -- --effects "
                   "rate_delay=0.06,voltage_sag=4,axial_inflow=1.5 --steps 14000000 --seeds 2 --agents 64"),
    "betaflight": (["betaflight"], "0.5 h", f"{LOOP} betaflight {{betaflight}} runs/betaflight --seeds 1,2,3"),
    "ardupilot": (["ardupilot"], "0.7 h", f"{LOOP} ardupilot {{ardupilot}} runs/ardupilot --seeds 1,2,3"),
    "check": (["logs"], "5 min", "python3 tests/python/check_logs.py --data {logs} --out results/check-logs.csv"),
    "identify": (["logs"], "0.5 h", "python3 tests/python/identify_logs.py target/release/racer "
                 "results/identify-logs.csv {logs}"),
    "speed": ([], "1 min", "target/release/racer bench"),
    "parts": ([], "1 min", "target/release/racer bench --parts"),
    "threads": ([], "1 min", "target/release/racer bench --threads-model"),
}

# Steps that two idle Sapphire Rapids cores make in so many minutes (0.62 M a second); seeds.
TRAININGS = {"0.5": (18_600_000, 8), "1": (37_200_000, 4), "5": (186_000_000, 4), "15": (558_000_000, 4)}
COLUMNS = ["minutes", "seed", "steps_million", "fixed_percent", "lap_s", "lap_p05_s", "lap_p95_s", "best_s",
           "random_percent", "saturated_percent", "change_sq", "build"]


# What was tried, as it stands in tried.csv, and the settings that make it of today's defaults.
NARROW = ["env.gate_radius_begin=1", "env.gate_radius_full=0"]
ONCE = [*NARROW, "env.reset.retry_share=0", "ppo.average=0"]
SETTINGS = {
    "today": [],
    "gates as they are": NARROW,
    "gates as they are, failures not tried again": [*NARROW, "env.reset.retry_share=0"],
    "and weights as they are": ONCE,
    "and gamma 0.995": [*ONCE, "ppo.gamma=0.995"],
    "and gamma 0.985": [*ONCE, "ppo.gamma=0.985"],
    "and 512 environments, 32 minibatches": [*ONCE, "ppo.environments=512", "ppo.minibatches=32"],
    "and clip 0.3": [*ONCE, "ppo.clip=0.3"],
    "and learning_rate 1.5e-3": [*ONCE, "ppo.learning_rate=1.5e-3"],
    "and max_gradient_norm 100": [*ONCE, "ppo.max_gradient_norm=100"],
    "and value_coefficient 0.05": [*ONCE, "ppo.value_coefficient=0.05"],
}


def build():
    """The commit that is measured."""
    command = ["git", "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def evaluated(run):
    """The evaluation of the policy that a finished training chose."""
    return json.loads((run / "evaluation.json").read_text())


def percent(share):
    return f"{100 * share:.1f}"


def trained(minutes, seed, run):
    """The row of a finished training."""
    best = evaluated(run)
    fixed, lap = best["fixed"], best["fixed"]["lap_time_s"]
    numbers = [f"{TRAININGS[minutes][0] / 1e6:.1f}", percent(fixed["lap_completion"])]
    numbers += [f"{lap[k]:.2f}" for k in ["median", "p05", "p95", "best"]]
    numbers += [percent(best["random"]["lap_completion"]), percent(fixed["saturated_share"])]
    return [minutes, seed, *numbers, f"{fixed['mean_action_change_sq']:.4f}", build()]


def training(racer, only, threads):
    """Trainings of half a minute to fifteen minutes, as steps, so that they repeat bit for bit on any machine."""
    path = HERE / "training.csv"
    done = {(r["minutes"], r["seed"]) for r in csv.DictReader(path.open())} if path.exists() else set()
    if not done:
        path.write_text(",".join(COLUMNS) + "\n")
    for minutes, (steps, seeds) in TRAININGS.items():
        for seed in map(str, range(1, seeds + 1)):
            if (minutes, seed) in done or (only and f"{minutes}:{seed}" not in only.split(",")):
                continue
            run = RUNS / f"minutes{minutes}-{seed}"
            new = ["--config", "a2rl", "--steps", str(steps), "--seed", seed, "--out", run]
            command = [racer, "train", *(["--resume", run] if run.exists() else new)]
            subprocess.run([*command, *(["--threads", threads] if threads else [])], cwd=ROOT, check=True)
            with path.open("a", newline="") as file:
                csv.writer(file, lineterminator="\n").writerow(trained(minutes, seed, run))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--with", dest="given", nargs="*", default=[], metavar="KEY=VALUE",
                        help="betaflight=PROGRAM, ardupilot=PROGRAM, logs='LOG...'; "
                        "for training: only=MINUTES:SEED,..., threads=N")
    parser.add_argument("--racer", type=pathlib.Path, default=ROOT / "target/release/racer", help="for training")
    options = parser.parse_args()
    given = dict(pair.split("=", 1) for pair in options.given)
    unknown = [name for name in options.names if name not in COMMANDS and name != "training"]
    if unknown:
        parser.error(f"no measurement {', '.join(unknown)}; there are training, {', '.join(COMMANDS)}")
    for name in options.names:
        if name == "training":
            training(options.racer, given.get("only"), given.get("threads"))
            continue
        needs, _, command = COMMANDS[name]
        missing = [key for key in needs if key not in given]
        if missing:
            parser.error(f"{name} needs --with {' '.join(f'{key}=...' for key in missing)}")
        command = command.format(**given)
        print(f"$ {command}", flush=True)
        subprocess.run(shlex.split(command), cwd=ROOT, check=True)
    if not options.names:
        print("training     2 h, each row at once  results/training.csv")
        for name, (needs, time, command) in COMMANDS.items():
            print(f"{name:<12} {time:<8} {'needs ' + ', '.join(needs) if needs else '':<18} {command}")


if __name__ == "__main__":
    main()
