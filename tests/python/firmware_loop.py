#!/usr/bin/env python3
"""From a flight to a faster policy, through a real firmware: the whole loop, in laps.

    python tests/python/firmware_loop.py target/release/racer betaflight betaflight_SITL OUT
        [--seeds 1,2,3] [--steps 80000000] [--laps 10] [--vehicle seed_class] [--seconds 120]
        [--excitations 2] [--settings FILE]
    python tests/python/firmware_loop.py target/release/racer ardupilot arducopter OUT

The firmware flies the excitation, racer identifies the vehicle from its log and extends it by what it
diagnoses; then policies are trained in the vehicle as its file says, as identified and, where the
diagnosis names anything, as extended, and each flies the same laps through the same firmware. OUT is
a folder: what is there already is not made again, so that the loop can go on where it ended.
OUT/loop.csv has a line for each policy. Without seeds (--seeds "") it ends with the vehicles.
"""

import argparse
import csv
import re
import subprocess
import sys
import tomllib
from pathlib import Path

HEADER = ["vehicle", "seed", "steps", "forecast_s", "flown_s", "share", "laps", "complete", "ended", "flown_laps_s"]


def run(folder, *words):
    """What a command prints, and its exit code."""
    print("+", *words, file=sys.stderr)
    done = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True)
    name = "-".join(str(word) for word in words[1:3]).replace("/", "_")
    (folder / f"{name}.txt").write_text(done.stdout + done.stderr)
    return done.stdout + done.stderr, done.returncode


def flight(text):
    """Lap times of forecast and flight, s, and how it ended, from what `racer pilot --rehearse` prints."""
    rows = re.findall(r"^\d+ +(\S+(?: s)?) +(\S+(?: s)?)$", text, re.M)
    times = [[float(cell[:-2]) for cell in column if cell != "-"] for column in zip(*rows)] or [[], []]
    ended = re.search(r"ended: (.*)", text)
    return times[0], times[1], ended.group(1) if ended else "not flown"


def vehicles(args, firmware):
    """The vehicle's own file, what its flights tell of it, and that with what was diagnosed, by name."""
    logs = []
    for seed in range(1, args.excitations + 1):
        logs.append(f"excitation{seed}.mcap")
        if not (args.out / logs[-1]).exists():
            run(args.out, args.racer, "pilot", "--excite", args.seconds, "--seed", seed, "--vehicle", args.vehicle,
                "--log", logs[-1], *firmware)
    found = {"default": args.vehicle}
    if not (args.out / "identified.toml").exists():
        run(args.out, args.racer, "identify", *logs, "--base", args.vehicle, "--out", "identified.toml")
    if (args.out / "identified.toml").exists():
        found["identified"] = "identified.toml"
        if not (args.out / "extended.toml").exists():
            run(args.out, args.racer, "diagnose", *logs, "--vehicle", "identified.toml", "--extend", "extended.toml")
        extended = effects(args.out / "extended.toml")
        if extended and extended != effects(args.out / "identified.toml"):
            found["extended"] = "extended.toml"
    return found


def effects(file):
    """Which effects a vehicle has; none where there is no such file."""
    return set(tomllib.loads(file.read_text()).get("effects", {}).get("sizes", {})) if file.exists() else None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("racer", type=lambda path: Path(path).resolve())
    parser.add_argument("name", choices=["betaflight", "ardupilot"])
    parser.add_argument("firmware", type=lambda path: Path(path).resolve())
    parser.add_argument("out", type=Path)
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--steps", type=int, default=80_000_000)
    parser.add_argument("--laps", type=int, default=10)
    parser.add_argument("--vehicle", default="seed_class")
    parser.add_argument("--seconds", type=int, default=120)
    parser.add_argument("--excitations", type=int, default=2)
    parser.add_argument("--settings", type=lambda path: Path(path).resolve())
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    firmware = ["--rehearse", args.name, "--firmware", args.firmware]
    firmware += ["--settings", args.settings] if args.settings else []
    rows = []
    for name, vehicle in vehicles(args, firmware).items():
        for seed in filter(None, args.seeds.split(",")):
            policy = f"{name}-{seed}"
            if not (args.out / policy / "policy.safetensors").exists():
                run(args.out, args.racer, "train", "--vehicle", vehicle, "--steps", args.steps, "--seed", seed,
                    "--out", policy)
            text, code = run(args.out, args.racer, "pilot", policy, "--laps", args.laps, "--vehicle", args.vehicle,
                             *firmware)
            forecast, flown, ended = flight(text)
            both = min(len(forecast), len(flown))
            mean = [f"{sum(times[:both or None]) / len(times[:both or None]):.3f}" if times else ""
                    for times in (forecast, flown)]
            share = f"{float(mean[1]) / float(mean[0]):.3f}" if both else ""
            rows.append([name, seed, args.steps, *mean, share, len(flown), int(code == 0), ended,
                         " ".join(f"{lap:.3f}" for lap in flown)])
            with open(args.out / "loop.csv", "w", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])
            print(*rows[-1])


if __name__ == "__main__":
    main()
