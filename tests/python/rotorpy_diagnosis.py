#!/usr/bin/env python3
"""What `racer diagnose` says of flights in a simulator that nobody here wrote: rotorpy's multirotor.

    python tests/python/rotorpy_diagnosis.py RACER OUT.csv [--seconds 60] [--only rotor_drag] [--log DIR]

A pilot flies doublets, punches, dashes and climbs by body rates and thrust (`cmd_ctbr`). Rotor drag, inflow,
translational lift, wind, gusts and a load are switched on one by one in rotorpy's own equations; rates, motors' lag and
drag are always its own. The base vehicle is what `racer identify` makes of a first flight with nothing switched on. A
line of OUT.csv is a flight, with noise of its own: what was on, what was said.
"""

import argparse
import csv
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from rotorpy.vehicles.multirotor import Multirotor
from rotorpy_laps import COLUMNS, MAPPING, RATE_GAIN, vehicle
from scipy.spatial.transform import Rotation

STEP_S, PERIOD_S, SEGMENT_S = 0.002, 0.02, 1.5
MASS, FULL_N, G = 0.8, 40.0, 9.81
MAX_RATE = np.array([12.0, 12.0, 5.0])
HOVER = 3000.0 * np.sqrt(MASS * G / FULL_N)

# What is switched on, the names that are right for it, and two sizes: 1/s, 1/s, 1/m, m/s, m/s, share.
CAUSES = {
    "none": ([], [0, 0, 0, 0, 0, 0]),
    "rotor_drag": (["rotor_drag"], [0.15, 0.4]),
    "inflow": (["axial_inflow"], [0.4, 1.0]),
    "lift": (["translational_lift"], [0.01, 0.03]),
    "wind": (["steady_wind"], [2.0, 4.0]),
    "gusts": (["gusts", "steady_wind"], [2.0, 4.0]),
    "load": (["mass_or_density"], [0.1, 0.25]),
}
# A rate loop of P alone behind motors with a lag, and a drag of each axis by itself (a share of 1), are no compact
# model's: neither right nor wrong.
OWN = {"rate_delay", "yaw_delay", "rate_second_order", "yaw_second_order", "rate_slew_limit", "yaw_slew_limit",
       "mixer_room", "mixer_thrust_loss", "axis_drag"}


def parameters(cause, size):
    """rotorpy's, with `cause` switched on."""
    flying = {"model": {"parameters": {"gravity_m_s2": G, "drag_1_m": [0.012, 0.014, 0.02]}},
              "setpoint": {"weight_n": MASS * G, "coefficients_n": [FULL_N, 0, 0, 0, 0, 0]}, "start": {"voltage_v": 24.0}}
    made = vehicle(flying) | {"k_w": RATE_GAIN}
    per_rotor = MASS / 4
    made |= {"rotor_drag": {"k_d": size * per_rotor / HOVER}, "inflow": {"k_z": size * per_rotor / HOVER},
             "lift": {"k_h": size * per_rotor}, "load": {"mass": MASS * (1 + size)}}.get(cause, {})
    return made


class Pilot:
    """Holds a place, and leaves it for something else every so often."""

    def __init__(self, rng):
        self.rng, self.until, self.kind = rng, 3.0, "hold"

    def command(self, t, s):
        """Body rates, rad/s, and thrust as a share of full."""
        if t >= self.until:
            self.kind = self.rng.choice(["doublet", "throttle", "dash", "climb"]) if self.kind == "hold" else "hold"
            self.began, self.until = t, t + SEGMENT_S * (1.5 if self.kind == "hold" else 1.0)
            self.axis, self.sign = self.rng.integers(3), self.rng.choice([-1, 1])
            self.share = self.rng.uniform(0.4, 1.0)
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
        rates = np.array([9.0 * tilt[0], 9.0 * tilt[1], 0.0])
        since = t - getattr(self, "began", 0.0)
        if self.kind == "doublet" and since < 0.24:
            rates[self.axis] = self.sign * self.share * 0.8 * MAX_RATE[self.axis] * (1 if since < 0.12 else -1)
        if self.kind == "throttle" and since < 0.4:
            thrust *= 1 + 1.2 * self.share if self.sign > 0 else 1 - 0.7 * self.share
        return np.clip(rates, -MAX_RATE, MAX_RATE), float(np.clip(thrust, 0.03, 1.0))


def flown(cause, size, seconds, seed):
    """A flight as rows of COLUMNS."""
    rng = np.random.default_rng(seed)
    craft = Multirotor(parameters(cause, size), control_abstraction="cmd_ctbr", integrator_kwargs={"method": "RK23"})
    s = {"x": np.array([0.0, 0.0, 15.0]), "v": np.zeros(3), "q": np.array([0.0, 0, 0, 1]), "w": np.zeros(3),
         "wind": np.zeros(3), "rotor_speeds": np.full(4, HOVER)}
    pilot, rows, gust = Pilot(rng), [], np.zeros(3)
    steady = size * np.array([0.8, 0.6, 0]) if cause == "wind" else np.zeros(3)
    rates, share = np.zeros(3), 0.2
    for i in range(int(seconds / STEP_S)):
        t = i * STEP_S
        if i % round(PERIOD_S / STEP_S) == 0:
            rates, share = pilot.command(t, s)
            if cause == "gusts":
                # A second of memory.
                keep = np.exp(-PERIOD_S)
                gust = keep * gust + size * np.sqrt(1 - keep**2) * rng.normal(size=3) * [1, 1, 0.3]
        s["wind"] = steady + gust
        control = {"cmd_thrust": share * FULL_N, "cmd_w": rates}
        turned = Rotation.from_quat(s["q"])
        force = turned.inv().apply(craft.statedot(s, control, STEP_S)["vdot"] + [0, 0, G])
        volts = 24.5 - 0.01 * t + rng.normal(0, 0.02)
        rows.append([t, *rates, share, *(s["w"] + rng.normal(0, 0.02, 3)), *(force + rng.normal(0, 0.2, 3)), *s["x"],
                     s["q"][3], *s["q"][:3], *turned.inv().apply(s["v"]), volts, *s["rotor_speeds"]])
        s = craft.step(s, control, STEP_S)
    return rows


def written(folder, name, rows):
    path = folder / f"{name}.csv"
    np.savetxt(path, rows, fmt="%.7g", delimiter=",", header=",".join(COLUMNS), comments="")
    (folder / "rotorpy.toml").write_text(MAPPING.format(mass=MASS, rates=np.degrees(MAX_RATE).round(3).tolist()))
    return path


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("racer", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--only", choices=CAUSES)
    parser.add_argument("--log", type=Path)
    args = parser.parse_args()
    folder = args.log or Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    mapping, base = ["--mapping", folder / "rotorpy.toml"], folder / "base.toml"
    racer = args.racer.absolute()
    if not base.exists():
        first = written(folder, "first", flown("none", 0, args.seconds, 100))
        subprocess.run([racer, "identify", first, *mapping, "--out", base], check=True)
    new = not args.out.exists()
    with open(args.out, "a", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        if new:
            lines.writerow(["cause", "size", "seed", "seconds", "named", "suspected", "verdict", "right_first", "wrong",
                            "axis_share"])
        for cause, (right, sizes) in CAUSES.items():
            if args.only not in (None, cause):
                continue
            for seed, size in enumerate(sizes):
                log = written(folder, f"{cause}-{seed}", flown(cause, size, args.seconds, seed))
                answer = log.with_suffix(".json")
                answer.unlink(missing_ok=True)
                subprocess.run([racer, "diagnose", log, *mapping, "--vehicle", base, "--json", answer], check=True,
                               stdout=subprocess.DEVNULL)
                said = json.loads(answer.read_text())
                named = [f for f in said["findings"] if f["status"] != "suspected" and f["effect"] not in OWN]
                wrong = [f["effect"] for f in named if not set(f["members"]) & set(right)]
                suspected = [f["effect"] for f in said["findings"] if f["status"] == "suspected"]
                # Another mass is thrust that moved against the base vehicle, named or not.
                moved = any(d["parameter"].startswith("thrust over mass") for d in said["drift"])
                first = named[0]["effect"] in right if named else cause == "load" and moved
                shares = [f["parameters"]["share"] for f in said["findings"]
                          if f["effect"] == "axis_drag" and f["status"] != "suspected"]
                share = "".join("{value:.3f} ({low:.3f} to {high:.3f})".format(**s) for s in shares)
                lines.writerow([cause, size, seed, args.seconds, " ".join(f["effect"] for f in named),
                                " ".join(suspected), said["verdict"], int(first), " ".join(wrong), share])
                file.flush()


if __name__ == "__main__":
    main()
