#!/usr/bin/env python3
"""What `racer diagnose` says of flights in a simulator that nobody here wrote: rotorpy's multirotor.

    python tests/python/rotorpy_diagnosis.py RACER OUT.csv [--n 100] [--seed 1] [--build COMMIT] [--only rotor_drag]

A pilot flies doublets, punches, dashes and climbs by body rates and thrust (`cmd_ctbr`). Nothing, one of CAUSES, two of
them or one of OUTSIDE is switched on in rotorpy's own equations, of a size drawn between two; rates, motors' lag and
drag are always its own. The base vehicle is what `racer identify` makes of a first flight with nothing switched on. A
line of OUT.csv is a flight, with noise of its own: what was on, what was said. Flights that it has are not flown again.
"""

import argparse
import csv
import functools
import json
import multiprocessing
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from rotorpy.vehicles.multirotor import Multirotor
from rotorpy_laps import COLUMNS, MAPPING, RATE_GAIN, vehicle
from scipy.spatial.transform import Rotation

STEP_S, PERIOD_S, SEGMENT_S = 0.002, 0.02, 1.5
# In a minute a pilot may turn but once about an axis.
FIRST_S = 180.0
MASS, FULL_N, G = 0.8, 40.0, 9.81
MAX_RATE = np.array([12.0, 12.0, 5.0])
MOTORS = ["u1", "u2", "u3", "u4"]
HOVER = 3000.0 * np.sqrt(MASS * G / FULL_N)

# What is switched on, the names that are right for it, and between which sizes.
CAUSES = {
    "rotor_drag": (["rotor_drag"], [0.15, 0.4]),  # 1/s
    "inflow": (["axial_inflow"], [0.4, 1.0]),  # 1/s
    "lift": (["translational_lift"], [0.01, 0.03]),  # 1/m
    "wind": (["steady_wind"], [2.0, 4.0]),  # m/s
    "gusts": (["gusts", "steady_wind"], [2.0, 4.0]),  # m/s
    "load": (["mass_or_density"], [0.1, 0.25]),  # share
}
# What the catalogue does not have: rotors that flap, by so much of a rate for each m/s, and in mid-flight drag that
# grows, or rotors that lose thrust, by such a share.
OUTSIDE = {"flap": ([], [0.02, 0.06]), "torn": ([], [1.0, 2.0]), "chipped": ([], [0.05, 0.15])}
# A rate loop of P alone behind motors with a lag, which makes up for no gyroscopic moment (k is -0.71), a drag of each
# axis by itself (a share of 1), and thrust by the square of a speed that lags, which rises later than it falls, are no
# compact model's: neither right nor wrong, nor is a set with one of them.
OWN = {"rate_delay", "yaw_delay", "rate_second_order", "yaw_second_order", "rate_slew_limit", "yaw_slew_limit",
       "mixer_room", "mixer_thrust_loss", "gyroscopic_coupling", "axis_drag"}
# What is hidden, and of how many flights.
GROUPS = {"none": 0.3, "one": 0.4, "two": 0.15, "outside": 0.15}
FIELDS = ["build", "seed", "log", "group", "hidden", "named", "suspected", "verdict", "first_right", "found", "of",
          "spurious", "unexplained", "axis_share"]


def drawn(seed, log, only):
    """The group of a flight, and what is switched on in it, with its size."""
    rng = np.random.default_rng([seed, log])
    group = rng.choice(list(GROUPS), p=list(GROUPS.values()))
    if only:
        return ("outside" if only in OUTSIDE else "one"), {only: size_of(only, rng)}
    if group == "none":
        return group, {}
    names = rng.permutation(list(OUTSIDE if group == "outside" else CAUSES))
    second = next(name for name in names[1:] if {name, names[0]} != {"wind", "gusts"})
    return group, {name: size_of(name, rng) for name in [names[0], second][: 2 if group == "two" else 1]}


def size_of(name, rng):
    low, high = (CAUSES | OUTSIDE)[name][1]
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def parameters(on):
    """rotorpy's, with what is `on`."""
    flying = {"model": {"parameters": {"gravity_m_s2": G, "drag_1_m": [0.012, 0.014, 0.02]}},
              "setpoint": {"weight_n": MASS * G, "coefficients_n": [FULL_N, 0, 0, 0, 0, 0]}, "start": {"voltage_v": 24.0}}
    made = vehicle(flying) | {"k_w": RATE_GAIN}
    per_rotor = MASS / 4
    size = lambda name: on.get(name, 0.0)
    made |= {"k_d": size("rotor_drag") * per_rotor / HOVER, "k_z": size("inflow") * per_rotor / HOVER,
             "k_h": size("lift") * per_rotor, "mass": MASS * (1 + size("load"))}
    # The rate loop holds against the moment with so much of an error.
    made["k_flap"] = size("flap") * RATE_GAIN * made["Ixx"] / 4 / HOVER
    return made


class Pilot:
    """Holds a place, and leaves it for something else and another heading every so often."""

    def __init__(self, rng):
        self.rng, self.until, self.kind, self.heading = rng, 3.0, "hold", 0.0

    def command(self, t, s):
        """Body rates, rad/s, and thrust as a share of full."""
        if t >= self.until:
            self.kind = self.rng.choice(["doublet", "throttle", "dash", "climb"]) if self.kind == "hold" else "hold"
            self.began, self.until = t, t + SEGMENT_S * (1.5 if self.kind == "hold" else 1.0)
            self.axis, self.sign = self.rng.integers(3), self.rng.choice([-1, 1])
            self.share = self.rng.uniform(0.4, 1.0)
            self.heading = self.rng.uniform(-np.pi, np.pi)
            turn = self.rng.uniform(0, 2 * np.pi)
            self.away = np.array([np.cos(turn), np.sin(turn), 0.0])
        turned = Rotation.from_quat(s["q"])
        wish = 1.2 * (np.array([0.0, 0.0, 15.0]) - s["x"]) - 1.6 * s["v"]
        wish *= min(1.0, 10.0 / max(np.linalg.norm(wish), 1e-9))
        if self.kind == "dash":
            wish = self.away * 16.0 * self.share + [0, 0, -s["v"][2]]
        if self.kind == "climb":
            wish = np.array([0, 0, self.sign * 9.0 * self.share]) - [s["v"][0], s["v"][1], 0]
        lift = wish + [0, 0, G]
        up = lift / np.linalg.norm(lift)
        thrust = MASS * max(lift @ turned.apply([0, 0, 1]), 1.0) / FULL_N
        tilt = np.cross([0, 0, 1], turned.inv().apply(up))
        ahead = turned.apply([1, 0, 0])
        off = np.angle(np.exp(1j * (self.heading - np.arctan2(ahead[1], ahead[0]))))
        rates = np.array([9.0 * tilt[0], 9.0 * tilt[1], np.clip(2.0 * off, -2.0, 2.0)])
        since = t - getattr(self, "began", 0.0)
        if self.kind == "doublet" and since < 0.24:
            rates[self.axis] = self.sign * self.share * 0.8 * MAX_RATE[self.axis] * (1 if since < 0.12 else -1)
        if self.kind == "throttle" and since < 0.4:
            thrust *= 1 + 1.2 * self.share if self.sign > 0 else 1 - 0.7 * self.share
        return np.clip(rates, -MAX_RATE, MAX_RATE), float(np.clip(thrust, 0.03, 1.0))


def flown(on, seconds, seed):
    """A flight as rows of COLUMNS and what the motors were sent."""
    rng = np.random.default_rng(seed)
    craft = Multirotor(parameters(on), control_abstraction="cmd_ctbr", integrator_kwargs={"method": "RK23"})
    s = {"x": np.array([0.0, 0.0, 15.0]), "v": np.zeros(3), "q": np.array([0.0, 0, 0, 1]), "w": np.zeros(3),
         "wind": np.zeros(3), "rotor_speeds": np.full(4, HOVER)}
    pilot, rows, gust = Pilot(rng), [], np.zeros(3)
    steady = on.get("wind", 0.0) * np.array([0.8, 0.6, 0])
    rates, share, left = np.zeros(3), 0.2, 1.0
    for i in range(int(seconds / STEP_S)):
        t = i * STEP_S
        if i % round(PERIOD_S / STEP_S) == 0:
            rates, share = pilot.command(t, s)
            if "gusts" in on:
                # A second of memory.
                keep = np.exp(-PERIOD_S)
                gust = keep * gust + on["gusts"] * np.sqrt(1 - keep**2) * rng.normal(size=3) * [1, 1, 0.3]
        if i == int(seconds / STEP_S / 2):
            craft.drag_matrix = craft.drag_matrix * (1 + on.get("torn", 0.0))
            left = 1 - on.get("chipped", 0.0)
            craft.k_eta *= left
        s["wind"] = steady + gust
        # The motors are sent what they were before: rotorpy asks for a thrust that it knows.
        control = {"cmd_thrust": share * FULL_N * left, "cmd_w": rates}
        turned = Rotation.from_quat(s["q"])
        force = turned.inv().apply(craft.statedot(s, control, STEP_S)["vdot"] + [0, 0, G])
        volts = 24.5 - 0.01 * t + rng.normal(0, 0.02)
        sent = np.clip(craft.get_cmd_motor_speeds(s, control) / craft.rotor_speed_max, 0, 1)
        rows.append([t, *rates, share, *(s["w"] + rng.normal(0, 0.02, 3)), *(force + rng.normal(0, 0.2, 3)), *s["x"],
                     s["q"][3], *s["q"][:3], *turned.inv().apply(s["v"]), volts, *s["rotor_speeds"], *sent])
        s = craft.step(s, control, STEP_S)
    return rows


def written(path, rows):
    np.savetxt(path, rows, fmt="%.7g", delimiter=",", header=",".join(COLUMNS + MOTORS), comments="")


def rises_later(finding):
    taus = finding["parameters"]
    return finding["effect"] == "thrust_asymmetric_lag" and taus["tau_up"]["value"] > taus["tau_down"]["value"]


def told(racer, folder, args, log):
    """Flies a flight and has it diagnosed: the line of OUT.csv."""
    group, on = drawn(args.seed, log, args.only)
    path = folder / f"{args.seed}-{log}.csv"
    if not path.exists():
        written(path, flown(on, args.seconds, [args.seed, log, 1]))
    answer = path.with_suffix(".json")
    answer.unlink(missing_ok=True)
    threads = os.environ | {"RAYON_NUM_THREADS": str(max(1, os.cpu_count() // args.jobs))}
    subprocess.run([racer, "diagnose", path, "--mapping", folder / "rotorpy.toml", "--vehicle", folder / "base.toml",
                    "--json", answer], check=True, stdout=subprocess.DEVNULL, env=threads)
    said = json.loads(answer.read_text())
    if not args.keep:
        path.unlink()
    right = [(CAUSES | OUTSIDE)[name][0] for name in on]
    is_right = lambda f: any(set(f["members"]) & set(names) for names in right)
    own = lambda f: not is_right(f) and (set(f["members"]) & OWN or rises_later(f))
    named = [f for f in said["findings"] if f["status"] != "suspected" and not own(f)]
    suspected = [f["effect"] for f in said["findings"] if f["status"] == "suspected"]
    # Another mass is thrust that moved against the base vehicle, named or not.
    moved = "load" in on and any(d["parameter"].startswith("thrust over mass") for d in said["drift"])
    first = is_right(named[0]) if named else moved
    is_named = lambda names: any(set(f["members"]) & set(names) for f in named)
    found = sum(is_named(names) or moved and "mass_or_density" in names for names in right)
    shares = [f["parameters"]["share"] for f in said["findings"]
              if f["effect"] == "axis_drag" and f["status"] != "suspected"]
    return [args.build, args.seed, log, group, " ".join(f"{name}={size:.4f}" for name, size in on.items()),
            " ".join(f["effect"] for f in named), " ".join(suspected), said["verdict"], int(first), found, len(on),
            " ".join(f["effect"] for f in named if not is_right(f)), int(said["verdict"] == "unexplained"),
            "".join("{value:.3f} ({low:.3f} to {high:.3f})".format(**share) for share in shares)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("racer", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--n", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--build", default="", help="what RACER was built from: a run goes on with flights of one build")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--only", choices=CAUSES | OUTSIDE)
    parser.add_argument("--folder", type=Path, help="where the base vehicle and the answers stay")
    parser.add_argument("--keep", action="store_true", help="the flights too, to be diagnosed again")
    args = parser.parse_args()
    folder, racer = args.folder or Path(tempfile.mkdtemp()), args.racer.absolute()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rotorpy.toml").write_text(MAPPING.format(mass=MASS, rates=np.degrees(MAX_RATE).round(3).tolist())
                                         + f"\n[motors]\ncommand = {{ fields = {json.dumps(MOTORS)} }}\n")
    if not (folder / "base.toml").exists():
        first = folder / "first.csv"
        written(first, flown({}, FIRST_S, 100))
        mapping = ["--mapping", folder / "rotorpy.toml"]
        subprocess.run([racer, "identify", first, *mapping, "--out", folder / "base.toml"], check=True)
    known = set()
    if args.out.exists():
        with open(args.out, newline="") as file:
            known = {(r["build"], r["seed"], r["log"]) for r in csv.DictReader(file)}
    left = [log for log in range(args.n) if (args.build, str(args.seed), str(log)) not in known]
    with open(args.out, "a", newline="") as file, multiprocessing.Pool(args.jobs) as pool:
        lines = csv.writer(file, lineterminator="\n")
        if not known:
            lines.writerow(FIELDS)
        for line in pool.imap_unordered(functools.partial(told, racer, folder, args), left):
            lines.writerow(line)
            file.flush()


if __name__ == "__main__":
    main()
