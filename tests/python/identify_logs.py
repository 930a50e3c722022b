#!/usr/bin/env python3
"""What `racer identify` makes of many logs: written, refused, and why; and whether what was written trains.

    python tests/python/identify_logs.py target/release/racer OUT.csv LOG...

Every log is one flight of its own vehicle. A line each: the log, the exit code, what the thrust was
identified from, R2 of roll, pitch, yaw and thrust on the validation part, which numbers the base
vehicle lent, why nothing was written, and whether `racer train --steps 40000` accepts the vehicle.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HEADER = ["log", "exit", "written", "thrust_from", "r2_roll", "r2_pitch", "r2_yaw", "r2_thrust", "lent", "why", "trains"]
SETTINGS = ["eval.agents=4", "budget.snapshots=1", "ppo.environments=64", "ppo.rollout=16", "ppo.minibatches=2"]
TRAIN = ["--steps", "40000"] + [word for setting in SETTINGS for word in ("--set", setting)]


def run(*args, cwd):
    return subprocess.run(args, cwd=cwd, capture_output=True, text=True, timeout=600)


def reason(text):
    """The `found` line of an error, or its last line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    found = [line.removeprefix("found").strip() for line in lines if line.startswith("found")]
    return (found or lines[-1:] or [""])[-1]


def one(racer, log, folder):
    vehicle, figures = folder / "v.toml", folder / "v.json"
    ran = run(racer, "identify", str(log), "--out", str(vehicle), "--json", str(figures), cwd=folder)
    row = dict.fromkeys(HEADER, "") | {"log": log.name, "exit": ran.returncode, "written": vehicle.exists()}
    if not vehicle.exists():
        return row | {"why": reason(ran.stderr)}
    found = json.loads(figures.read_text())
    for name in ["roll", "pitch", "yaw", "thrust"]:
        r2 = found["response"][name]["r2"]
        row[f"r2_{name}"] = "" if r2 is None else f"{r2:.3f}"
    row["thrust_from"] = found["vehicle"]["identified"]["thrust_from"]
    row["lent"] = " ".join(sorted(found["vehicle"]["identified"]["assumed"]))
    trained = run(racer, "train", "--vehicle", str(vehicle), *TRAIN, "--out", "run", cwd=folder)
    row["trains"] = trained.returncode == 0
    if trained.returncode:
        row["why"] = reason(trained.stderr)
    return row


def main():
    racer, out, *logs = sys.argv[1:]
    racer = str(Path(racer).resolve())
    with open(out, "w", newline="") as file:
        table = csv.DictWriter(file, HEADER, lineterminator="\n")
        table.writeheader()
        for log in map(Path, logs):
            with tempfile.TemporaryDirectory() as folder:
                row = one(racer, log.resolve(), Path(folder))
            table.writerow(row)
            file.flush()
            print(f"{row['log']}: {'written' if row['written'] else 'refused'} {row['why']}", flush=True)


if __name__ == "__main__":
    main()
