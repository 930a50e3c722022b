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
# Pairs of flights: seed, how many, s each, about how long.
PAIRS = [(13, 100, 60, "1.5 h"), (14, 100, 120, "2 h"), (16, 40, 60, "0.5 h"),
         *((seed, 100, 60, "1 h") for seed in (18, 20, 21, 22, 23)), (24, 100, 300, "4 h"), (26, 60, 60, "1 h"),
         (27, 100, 300, "6 h")]
# Name: needs, about how long, and the command; a list of trainings is a command of its own.
COMMANDS = {
    **{f"against-seed{seed}": ([], about, f"{BENCH} --against --n {n} --seconds {length} --seed {seed} --jobs 2 "
                               f"--csv results/against-seed{seed}.csv") for seed, n, length, about in PAIRS},
    "against-voltage": ([], "0.2 h", f"{BENCH} --against --n 8 --seconds 60 --seed 44 --jobs 2 --only esc_voltage "
                        "--csv results/against-voltage.csv"),
    "against-by-motors": ([], "10 min", " && ".join(
        f"{BENCH} --against --by-motors --seconds 60 --jobs 2 --csv results/against-by-motors.csv {pairs}"
        for pairs in ["--seed 37 --n 1000", "--seed 33 --n 1000", "--seed 30 --n 200", "--seed 31 --n 12 --only imu_late",
                      "--seed 32 --n 12 --only gyro_filter"])),
    "measured": (["logs"], "5 min", "python3 tests/python/measured_flights.py target/release/racer {logs} "
                 "results/measured-flights.csv"),
    "plan": ([], "10 min", f"{BENCH} --plan --n 200 --seed 8 --jobs 2 --csv results/plan.csv"),
    "own": ([], "1 h", f"{BENCH} --tier matched --n 300 --seed 62 --jobs 2 --extended --csv results/own-truth.csv"),
    "unmatched": ([], "0.5 h", f"{BENCH} --n 14 --seed 32 --tier unmatched --jobs 2"),
    "outside": ([], "0.5 h", f"{BENCH} --n 14 --seed 33 --tier outside --jobs 2"),
    "race": ([], "0.5 h", f"{BENCH} --n 12 --seed 34 --tier matched --style race --jobs 2"),
    "other": ([], "1.5 h", f"{BENCH} --tier other --n 300 --seed 30 --seconds 100 --jobs 2 --extended "
              "--csv results/other-truth.csv"),
    "other-300s": ([], "3.5 h", f"{BENCH} --tier other --n 300 --seed 39 --seconds 300 --jobs 2 --extended "
                   "--csv results/other-truth.csv"),
    "other-seed40": ([], "5 h", f"{BENCH} --tier other --n 300 --seed 40 --seconds 300 --jobs 2 --extended "
                     "--csv results/other-truth-seed40.csv"),
    "rotorpy-diagnosis": ([], "1 h", "python3 tests/python/rotorpy_diagnosis.py target/release/racer "
                          "results/rotorpy-diagnosis.csv --n 100 --seed 2"),
    "retraining": ([], "0.5 h", "cargo bench --bench retraining -- --effects "
                   "rate_delay=0.06,voltage_sag=4,axial_inflow=1.5 --steps 14000000 --seeds 2 --agents 64"),
    "retraining-by-motor": ([], "0.3 h", "cargo bench --bench retraining -- --by-motor --effects "
                            "stick_filter=0.02,load_power=4,inflow_root=1.5 --steps 14000000 --seeds 4 --agents 64 "
                            "--seconds 120 --csv results/retraining-by-motor.csv"),
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
TRAININGS = {"0.5": (18_600_000, 8), "1": (37_200_000, 8), "5": (186_000_000, 8), "15": (558_000_000, 4)}
COLUMNS = ["minutes", "seed", "steps_million", "fixed_percent", "lap_s", "lap_p05_s", "lap_p95_s", "best_s",
           "random_percent", "saturated_percent", "change_sq", "build"]


# What was tried for short budgets: its name in tried.csv, what makes it of today's defaults, and for each track and
# million steps how many seeds.
PAD = ["env.reset.pad_share=0.15"]
SOON = [*PAD, "env.gate_radius_full=4.32"]
NARROW = [*PAD, "env.gate_radius_begin=1", "env.gate_radius_full=0"]
AVERAGED = [*NARROW, "env.reset.retry_share=0"]
OLDER = [*AVERAGED, "ppo.average=0"]
S2, S1, SPLIT_S = "a2rl_s2", "a2rl_s1", "uzh_split_s"
EIGHT = {(S2, 18.6): 8}
TRIED = {
    "gamma 0.995 (the default before)": (
        [*OLDER, "ppo.gamma=0.995"], {**EIGHT, (S2, 37.2): 4, (S2, 186.0): 4, (SPLIT_S, 18.6): 2, (S1, 18.6): 2}),
    "gamma 0.99": (OLDER, {**EIGHT, (S2, 37.2): 4, (S2, 186.0): 4, (SPLIT_S, 18.6): 2, (S1, 18.6): 2}),
    "gamma 0.985": ([*OLDER, "ppo.gamma=0.985"], EIGHT),
    "gamma 0.99, 512 environments, 32 minibatches": ([*OLDER, "ppo.environments=512", "ppo.minibatches=32"], EIGHT),
    "gamma 0.99, clip 0.3": ([*OLDER, "ppo.clip=0.3"], {(S2, 18.6): 4}),
    "gamma 0.99, learning_rate 1.5e-3": ([*OLDER, "ppo.learning_rate=1.5e-3"], EIGHT),
    "gamma 0.99, max_gradient_norm 100": ([*OLDER, "ppo.max_gradient_norm=100"], EIGHT),
    "gamma 0.99, value_coefficient 0.05": ([*OLDER, "ppo.value_coefficient=0.05"], EIGHT),
    "gamma 0.99, lambda 0.9": ([*OLDER, "ppo.lambda=0.9"], EIGHT),
    "gamma 0.99, time 0.05": ([*OLDER, "env.reward.time=0.05"], {(S2, 18.6): 4}),
    "gamma 0.99, resets at up to 20 m/s": ([*OLDER, "env.reset.speed_m_s=[0.0,20.0]"], {(S2, 18.6): 2}),
    "average": (AVERAGED, EIGHT),
    "average, learning_rate_final 3e-4": ([*AVERAGED, "ppo.learning_rate_final=3e-4"], {(S2, 18.6): 4}),
    "average, retry": (NARROW, {**EIGHT, (S2, 14.4): 8}),
    "average, retry 0.8": ([*NARROW, "env.reset.retry_share=0.8"], EIGHT),
    "average, retry, value_coefficient 0.05": ([*NARROW, "ppo.value_coefficient=0.05"], {(S2, 14.4): 6}),
    "average, retry, wide to 4.3 M": (SOON, {(S2, 14.4): 8}),
    "average, retry, wide 3 to 4.3 M": ([*SOON, "env.gate_radius_begin=3"], {(S2, 14.4): 6}),
    "average, retry, wide to 4.3 M, gamma 0.985": ([*SOON, "ppo.gamma=0.985"], {(S2, 14.4): 8}),
    "average, retry, wide to 4.3 M, time 0.05": ([*SOON, "env.reward.time=0.05"], {(S2, 14.4): 8}),
    "average, retry, wide": (PAD, {**EIGHT, (S2, 37.2): 4, (SPLIT_S, 18.6): 2, (S1, 18.6): 2}),
    "average, retry, wide, pad_share 0.3 (the default)": (
        [], {(S2, 14.4): 8, **EIGHT, (S2, 37.2): 4, (S2, 186.0): 4, (SPLIT_S, 18.6): 2, (S1, 18.6): 2}),
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
    learning()


def learning():
    """The snapshots of every training at hand; rows of others stay."""
    path = HERE / "learning.csv"
    rows = {(r["minutes"], r["seed"], r["steps_million"]): list(r.values()) for r in
            (csv.DictReader(path.open()) if path.exists() else [])}
    for minutes, (_, seeds) in TRAININGS.items():
        for seed in map(str, range(1, seeds + 1)):
            of = RUNS / f"minutes{minutes}-{seed}/snapshots.json"
            for taken in json.loads(of.read_text()) if of.exists() else []:
                lap, million = taken["fixed"]["lap_time_s"], f"{taken['steps'] / 1e6:.1f}"
                percents = [percent(taken[start]["lap_completion"]) for start in ["fixed", "random"]]
                rows[minutes, seed, million] = [minutes, seed, million, *percents, f"{lap['median']:.2f}" if lap else ""]
    with path.open("w", newline="") as file:
        file.write("minutes,seed,steps_million,fixed_percent,random_percent,lap_s\n")
        ordered = sorted(rows, key=lambda key: [float(part) for part in key])
        csv.writer(file, lineterminator="\n").writerows(rows[key] for key in ordered)


def tried(racer, only, threads):
    """Half a minute and more with other settings; `only` is the name of one of them."""
    path = HERE / "tried.csv"
    done = {(r["track"], r["setting"], r["steps_million"], r["seed"]) for r in csv.DictReader(path.open())}
    wanted = {name: of for name, of in TRIED.items() if only in (None, name)}
    runs = [(name, settings, *where, str(seed)) for name, (settings, places) in wanted.items()
            for where, seeds in places.items() for seed in range(1, seeds + 1)]
    for place, (name, settings, track, million, seed) in enumerate(runs):
        if (track, name, f"{million:.1f}", seed) in done:
            continue
        run = RUNS / f"tried-{place}"
        sets = [part for setting in [f"track={track}", *settings] for part in ("--set", setting)]
        command = [racer, "train", "--config", "a2rl", "--steps", f"{million * 1e6:.0f}", "--seed", seed, "--out", run]
        subprocess.run([*command, *sets, *(["--threads", threads] if threads else [])], cwd=ROOT, check=True)
        with path.open("a", newline="") as file:
            csv.writer(file, lineterminator="\n").writerow(setting_row(track, name, seed, million, run))


def setting_row(track, name, seed, million, run):
    """The row of a finished training with other settings."""
    best = evaluated(run)
    fixed = best["fixed"]
    lap = f"{fixed['lap_time_s']['median']:.2f}" if fixed["lap_time_s"] else ""
    shares = [fixed["lap_completion"], best["random"]["lap_completion"], fixed["saturated_share"]]
    laps, random, saturated = map(percent, shares)
    return [track, name, seed, f"{million:.1f}", laps, lap, random, saturated, build()]


TRAINED = {"training": training, "tried": tried}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--with", dest="given", nargs="*", default=[], metavar="KEY=VALUE",
                        help="betaflight=PROGRAM, ardupilot=PROGRAM, logs='LOG...'; "
                        "for training: only=MINUTES:SEED,..., threads=N; for tried: only=NAME, threads=N")
    parser.add_argument("--racer", type=pathlib.Path, default=ROOT / "target/release/racer", help="for trainings")
    options = parser.parse_args()
    given = dict(pair.split("=", 1) for pair in options.given)
    unknown = [name for name in options.names if name not in {**COMMANDS, **TRAINED}]
    if unknown:
        parser.error(f"no measurement {', '.join(unknown)}; there are {', '.join([*TRAINED, *COMMANDS])}")
    for name in options.names:
        if name in TRAINED:
            TRAINED[name](options.racer, given.get("only"), given.get("threads"))
            continue
        needs, _, command = COMMANDS[name]
        missing = [key for key in needs if key not in given]
        if missing:
            parser.error(f"{name} needs --with {' '.join(f'{key}=...' for key in missing)}")
        command = command.format(**given)
        print(f"$ {command}", flush=True)
        for one in command.split(" && "):
            subprocess.run(shlex.split(one), cwd=ROOT, check=True)
    if not options.names:
        print("training     3 h, each row at once  results/training.csv, learning.csv")
        print("tried        6 h, each row at once  results/tried.csv")
        for name, (needs, time, command) in COMMANDS.items():
            print(f"{name:<12} {time:<8} {'needs ' + ', '.join(needs) if needs else '':<18} {command}")


if __name__ == "__main__":
    main()
