#!/usr/bin/env python3
"""What `racer diagnose` names in measured flights, and whether the extended vehicle predicts one it has not seen.

    python tests/python/measured_flights.py target/release/racer FLIGHTS OUT.csv [SET...]

FLIGHTS is a folder with the logs of the sets below, which RESULTS.md says where to get. Of each set the base vehicle
is identified from all flights but the last, and they are diagnosed against it; both vehicles then predict the last
flight (`racer predict`), and the extended one is trained for a moment. A line each: what was named, with its size and
95 % interval, and for every signal of the unseen flight the error (RMS) of both vehicles. Of a set of one flight there
is no unseen one.

A diagnosis leaves its own last flight out, so that one flight more is given up by this. So all flights are diagnosed as
well ("all"): the errors on the last one are then the diagnosis' own, of a fit to as many flights as the base has.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HEADER = ["set", "kind", "what", "unit", "value", "low", "high", "build"]
SETS = {
    "NeuroBEM": (["20210218170320seg2", "20210223104803seg2", "20210218172600seg1", "20210218171908seg2"], []),
    "IndiFlight": (["LOG00267", "LOG00269", "LOG00281"], []),
    "Roma F5": (["roma_f5_log1.csv", "roma_f5_log2.csv", "roma_f5_log3.csv"], []),
    "NanoBench": (["B2_circle_fast_rep1", "B5_helix_fast_rep1", "B7_oval_fast_rep3"], ["--mass", "0.033"]),
    "Gecko": (["gecko_btfl_002.bbl"], []),
}
SETTINGS = ["eval.agents=4", "budget.snapshots=1", "ppo.environments=64", "ppo.rollout=16", "ppo.minibatches=2"]
TRAIN = ["--steps", "40000", "--out", "run"] + [word for setting in SETTINGS for word in ("--set", setting)]


def run(*args, cwd, may_fail=False):
    ran = subprocess.run([str(a) for a in args], cwd=cwd, capture_output=True, text=True, timeout=900)
    if ran.returncode and not may_fail:
        sys.exit(f"{' '.join(map(str, args))}\n{ran.stderr}")
    return ran


def named(findings):
    for f in findings:
        if f["status"] != "suspected":
            what = " or ".join(dict.fromkeys(f["members"]))
            for name, size in f["parameters"].items():
                yield [f"{what}: {name}", size["unit"], *(f"{size[k]:.4g}" for k in ("value", "low", "high"))]


def predicted(racer, log, vehicles, cwd):
    both = [word for v in vehicles for word in ("--vehicle", v)]
    said = json.loads(run(racer, "predict", log, *both, "--json", cwd=cwd).stdout)
    for channel in said["channels"]:
        yield [channel["name"], channel["unit"], *(f"{score['rmse']:.4g}" for score in channel["scores"])]


def diagnosed(racer, logs, name, cwd):
    wanted = ["--vehicle", "base.toml", "--json", f"{name}.json", "--extend", f"{name}.toml"]
    ran = run(racer, "diagnose", *logs, *wanted, cwd=cwd, may_fail=True)
    return json.loads((cwd / f"{name}.json").read_text()), ran


def with_all(racer, logs, cwd):
    found, _ = diagnosed(racer, logs, "all", cwd)
    for what, unit, value, low, high in named(found["findings"]):
        yield "named of all", what, unit, value, low, high
    written = int((cwd / "all.toml").exists())
    yield "vehicle of all", found.get("not_extended") or "all.toml", "", written, "", ""
    for name, error in found["held_out"].items():
        if name.split()[0] not in ("turn", "push"):
            yield "held out of all", name, error["unit"], f"{error['before']:.4g}", f"{error['after']:.4g}", ""


def one(racer, logs, options, cwd):
    known = logs[:-1] or logs
    run(racer, "identify", *known, *options, "--partial", "--out", "base.toml", cwd=cwd)
    if len(logs) > 1:
        yield from with_all(racer, logs, cwd)
    found, ran = diagnosed(racer, known, "x", cwd)
    for what, unit, value, low, high in named(found["findings"]):
        yield "named", what, unit, value, low, high
    if not (cwd / "x.toml").exists():
        yield "no vehicle", found.get("not_extended") or ran.stderr.splitlines()[-1], "", "", "", ""
        return
    trained = run(racer, "train", "--vehicle", "x.toml", *TRAIN, cwd=cwd, may_fail=True).returncode == 0
    yield "trains", "x.toml", "", int(trained), "", ""
    if logs[-1] not in known:
        for what, unit, base, extended in predicted(racer, logs[-1], ["base.toml", "x.toml"], cwd):
            yield "base and extended", what, unit, base, extended, ""


def main():
    racer, flights, out, *only = sys.argv[1:]
    racer, flights = Path(racer).resolve(), Path(flights).resolve()
    build = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    with open(out, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HEADER)
        for name in only or SETS:
            keys, options = SETS[name]
            logs = [next(p for p in sorted(flights.rglob("*")) if key in p.name and p.is_file()) for key in keys]
            with tempfile.TemporaryDirectory() as folder:
                for row in one(racer, logs, options, Path(folder)):
                    table.writerow([name, *row, build])
                    print(name, *row, flush=True)


if __name__ == "__main__":
    main()
