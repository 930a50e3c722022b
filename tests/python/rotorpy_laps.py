#!/usr/bin/env python3
"""Flies policies, from their files alone, in a simulator that nobody here wrote: rotorpy's multirotor.

    python tests/python/rotorpy_laps.py OUT.csv POLICY.safetensors... [--laps 10] [--log DIR]

Mass, full thrust, drag and start are the policy's vehicle's, as its file says. Inertia (of an even ellipsoid), four
rotors with a lag, and the rate loop (`cmd_ctbr`) are rotorpy's, in steps of a millisecond. A line of OUT.csv is a policy: its laps in the file's own equations beside those in rotorpy. `--log`
keeps the flights as CSV, with sensor noise, and what `racer identify --mapping DIR/rotorpy.toml DIR/*.csv` needs.
"""

import argparse
import csv
from pathlib import Path

import numpy as np
from fly import Pilot, read, simulate, turn
from rotorpy.vehicles.multirotor import Multirotor
from scipy.spatial.transform import Rotation

STEP_S = 0.001
ARM_M, TORQUE_M, LAG_S, RATE_GAIN = 0.08, 0.016, 0.016, 30.0
FASTEST = 3000.0


COLUMNS = ("t wx_sp wy_sp wz_sp throttle wx wy wz ax ay az x y z qw qx qy qz vx vy vz volts m1 m2 m3 m4").split()
MAPPING = """time = {{ field = "t" }}

[setpoint]
rate = {{ fields = ["wx_sp", "wy_sp", "wz_sp"] }}
thrust = {{ field = "throttle" }}

[imu]
gyro = {{ fields = ["wx", "wy", "wz"] }}
specific_force = {{ fields = ["ax", "ay", "az"] }}

[odometry]
position = {{ fields = ["x", "y", "z"] }}
attitude = {{ fields = ["qw", "qx", "qy", "qz"] }}
velocity = {{ fields = ["vx", "vy", "vz"] }}

[battery]
voltage = {{ field = "volts" }}

[rotors]
speed = {{ fields = ["m1", "m2", "m3", "m4"] }}

[vehicle]
mass_kg = {mass}
max_rate_deg_s = {rates}
"""


def vehicle(flying):
    """rotorpy's parameters for the vehicle of a policy."""
    model, setpoint = flying["model"]["parameters"], flying["setpoint"]
    mass = setpoint["weight_n"] / model["gravity_m_s2"]
    full = np.dot(setpoint["coefficients_n"], [1, 1, 1, 1, flying["start"]["voltage_v"], flying["start"]["voltage_v"]])
    thrust = full / 4 / FASTEST**2
    drag = np.array(model["drag_1_m"]) * mass
    inertia = mass * np.array([0.11**2 + 0.045**2, 0.11**2 + 0.045**2, 2 * 0.11**2]) / 5
    corners = {f"r{i}": ARM_M * np.array([x, y, 0.0]) for i, (x, y) in enumerate([(1, 1), (1, -1), (-1, -1), (-1, 1)])}
    return {"mass": mass, "Ixx": inertia[0], "Iyy": inertia[1], "Izz": inertia[2], "Ixy": 0.0, "Ixz": 0.0, "Iyz": 0.0,
            "c_Dx": drag[0], "c_Dy": drag[1], "c_Dz": drag[2], "num_rotors": 4, "rotor_pos": corners,
            "rotor_directions": np.array([1, -1, 1, -1]), "rotor_speed_min": 0.0, "rotor_speed_max": FASTEST,
            "k_eta": thrust, "k_m": TORQUE_M * thrust, "tau_m": LAG_S, "k_w": RATE_GAIN}


def laps(flying, tensors, wanted, move, state):
    """Lap times, s, and how the flight ended. `move` goes on by a control period, `state` reads out."""
    pilot, period, passes = Pilot(flying, tensors), flying["model"]["parameters"]["dt_s"], []
    for step in range(int(20 * wanted / period)):
        try:
            _, action, setpoint = pilot.step(*state())
        except SystemExit as missed:
            return times(passes, len(pilot.gates)), str(missed)
        if pilot.passed is not None:
            passes.append((step - 1 + pilot.passed) * period)
        if len(passes) > wanted * len(pilot.gates):
            return times(passes, len(pilot.gates)), "the laps are flown"
        move(action, setpoint)
    return times(passes, len(pilot.gates)), "out of time"


def times(passes, gates):
    crossings = passes[::gates]
    return [after - before for before, after in zip(crossings, crossings[1:])]


def own(flying, tensors, wanted):
    """In the file's own equations; nothing where these are not all that the training had."""
    if not flying["model"]["complete"]:
        return [], "effects beyond the equations of the file"
    start, model = flying["start"], flying["model"]
    now = [np.array(start["position_m"]), np.zeros(3), turn([0, 0, start["heading_rad"]]),
           np.array(start["command"], float), start["voltage_v"]]
    full = np.array(model["parameters"]["max_rate_rad_s"])

    def move(action, _):
        now[:] = simulate(model, *now, action)

    return laps(flying, tensors, wanted, move, lambda: (now[0], now[1], now[2], now[3][:3] * full, now[4]))


def in_rotorpy(flying, tensors, wanted, log):
    """In rotorpy; every other step is added to `log`."""
    start, model = flying["start"], flying["model"]["parameters"]
    w, x, y, z = turn([0, 0, start["heading_rad"]])
    now = {"x": np.array(start["position_m"], float), "v": np.zeros(3), "q": np.array([x, y, z, w]), "w": np.zeros(3),
           "wind": np.zeros(3), "rotor_speeds": np.full(4, 1.0)}
    craft = Multirotor(vehicle(flying), control_abstraction="cmd_ctbr")
    box, noise = {"state": now, "voltage": start["voltage_v"]}, np.random.default_rng(1)

    def note(s, setpoint, control):
        turned = Rotation.from_quat(s["q"])
        force = turned.inv().apply(craft.statedot(s, control, STEP_S)["vdot"] + [0, 0, craft.g])
        log.append([len(log) * 2 * STEP_S, *setpoint[:4], *(s["w"] + noise.normal(0, 0.02, 3)),
                    *(force + noise.normal(0, 0.2, 3)), *s["x"], s["q"][3], *s["q"][:3], *turned.inv().apply(s["v"]),
                    box["voltage"] + noise.normal(0, 0.02), *s["rotor_speeds"]])

    def move(_, setpoint):
        control = {"cmd_thrust": max(setpoint[4], 0.0), "cmd_w": setpoint[:3]}
        for i in range(round(model["dt_s"] / STEP_S)):
            before = box["state"]
            if i % 2 == 0:
                note(before, setpoint, control)
            box["state"] = craft.step(before, control, STEP_S)
            if box["state"]["x"][2] < start["position_m"][2]:
                # The pad carries it.
                box["state"] |= {"x": before["x"], "v": np.zeros(3), "q": before["q"], "w": np.zeros(3)}
        box["voltage"] += model["voltage_rate_v_s"] * model["dt_s"]

    def state():
        s = box["state"]
        return s["x"], s["v"], np.array([s["q"][3], *s["q"][:3]]), s["w"], box["voltage"]

    return laps(flying, tensors, wanted, move, state)


def keep(folder, name, flying, log):
    """A flight as CSV, and what its columns mean."""
    folder.mkdir(parents=True, exist_ok=True)
    np.savetxt(folder / f"{name}.csv", log, fmt="%.7g", delimiter=",", header=",".join(COLUMNS), comments="")
    model = flying["model"]["parameters"]
    mass = flying["setpoint"]["weight_n"] / model["gravity_m_s2"]
    rates = np.degrees(model["max_rate_rad_s"]).round(3).tolist()
    (folder / "rotorpy.toml").write_text(MAPPING.format(mass=mass, rates=rates))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("policies", type=Path, nargs="+")
    parser.add_argument("--laps", type=int, default=10)
    parser.add_argument("--log", type=Path)
    args = parser.parse_args()
    new = not args.out.exists()
    with open(args.out, "a", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        if new:
            rows.writerow(["policy", "forecast_s", "flown_s", "share", "laps", "ended", "flown_laps_s"])
        for path in args.policies:
            metadata, tensors = read(path)
            forecast, _ = own(metadata["flying"], tensors, args.laps)
            log = []
            flown, ended = in_rotorpy(metadata["flying"], tensors, args.laps, log)
            if args.log:
                keep(args.log, path.parent.name, metadata["flying"], log)
            both = min(len(forecast), len(flown)) or None
            mean = [f"{np.mean(x[:both]):.3f}" if x else "" for x in (forecast, flown)]
            share = f"{float(mean[1]) / float(mean[0]):.3f}" if both else ""
            rows.writerow([path.parent.name, *mean, share, len(flown), ended, " ".join(f"{x:.3f}" for x in flown)])
            file.flush()


if __name__ == "__main__":
    main()
