"""Flies a lap from a policy file alone: numpy, and nothing of racer.

    python3 tests/python/fly.py policy.safetensors [schema.json]

Everything comes from the file's description (docs/policy-file.md). Prints, as JSON, how far the self-test was off, the
lap of the nominal vehicle, which wrong conventions the self-test notices, and what a schema complains of.
"""

import json
import pathlib
import struct
import sys

import numpy as np


def read(path):
    """Metadata and tensors of a safetensors file."""
    data = pathlib.Path(path).read_bytes()
    (length,) = struct.unpack("<Q", data[:8])
    header = json.loads(data[8:8 + length])
    metadata = json.loads(header.pop("__metadata__")["racer"])
    body, tensors = data[8 + length:], {}
    for name, t in header.items():
        kind = {"F32": "<f4", "I32": "<i4"}[t["dtype"]]
        begin, end = t["data_offsets"]
        tensors[name] = np.frombuffer(body[begin:end], kind).reshape(t["shape"])
    return metadata, tensors


def rotation(q):
    """Body to world: columns are the body's axes."""
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Pilot:
    """The policy with what it keeps from step to step."""

    def __init__(self, flying, tensors):
        self.flying, self.tensors = flying, tensors
        self.gates = flying["gates"]["list"]
        self.share = np.array(flying["filter"]["share"])
        start = flying["start"]
        self.u = np.array(start["command"], float)
        self.actions = [np.array(a, float) for a in start["actions"]]
        self.target, self.last, self.passed = start["target"], None, None

    def step(self, p, v, q, w, voltage):
        """Observation, action and setpoint for a state; `passed` is the share of the last move before the gate."""
        self.passed = self.cross(p)
        gate = self.gates[self.target]
        g, c, r = np.array(gate["axes"]), np.array(gate["centre_m"]), rotation(q)
        values = {
            "position": g @ (p - c), "velocity": g @ v, "attitude": (g @ r).T.ravel(), "angular_rate": g @ r @ w,
            "command": self.u, "action_1": self.actions[0], "action_2": self.actions[1], "action_3": self.actions[2],
            "voltage": [voltage], "next_gate": gate["next_m"], "second_gate": gate["second_m"],
        }
        groups = self.flying["observation"]
        seen = np.concatenate([(np.array(values[o["name"]]) - o["offset"]) * o["scale"] for o in groups])
        action = self.answer(seen)
        self.u = self.u + self.share * (action - self.u)
        self.actions = [action] + self.actions[:2]
        self.last = p
        return seen, action, self.setpoint(action, voltage)

    def answer(self, x):
        for layer in self.flying["network"]["layers"]:
            x = np.tanh(x @ self.tensors[layer["weight"]].astype(float) + self.tensors[layer["bias"]])
        return x

    def cross(self, p):
        if self.last is None:
            return None
        gate = self.gates[self.target]
        g, c = np.array(gate["axes"]), np.array(gate["centre_m"])
        before, after = g @ (self.last - c), g @ (p - c)
        if not before[0] < 0 <= after[0]:
            return None
        share = before[0] / (before[0] - after[0])
        if np.hypot(*(before + share * (after - before))[1:]) > gate["radius_m"]:
            raise SystemExit(f"gate {gate['label']} was missed")
        self.target = (self.target + 1) % len(self.gates)
        return share

    def setpoint(self, a, voltage):
        s = self.flying["setpoint"]
        thrust = np.dot(s["coefficients_n"], [1, a[3], a[3]**2, a[3]**3, voltage, a[3] * voltage])
        rates = [a[k] * self.flying["action"][k]["at_one"] for k in range(3)]
        return np.array([*rates, (a[3] + 1) / 2, thrust, thrust / s["weight_n"]])


def product(q, r):
    (a, b), (c, d) = (q[0], q[1:]), (r[0], r[1:])
    return np.concatenate([[a * c - b @ d], a * d + c * b + np.cross(b, d)])


def turn(vector):
    half = np.linalg.norm(vector) / 2
    return np.concatenate([[np.cos(half)], np.sinc(half / np.pi) * np.asarray(vector) / 2])


def simulate(model, p, v, q, u, voltage, a):
    """One step of the vehicle, as `model.step` writes it."""
    m = model["parameters"]
    h, c = m["dt_s"], m["thrust_m_s2"]
    mean = u + np.array(m["mean_share"]) * (a - u)
    u = u + np.array(m["share"]) * (a - u)
    half = turn(np.array(m["max_rate_rad_s"]) * mean[:3] * h / 2)
    middle = product(q, half)
    q = product(middle, half)
    axes = rotation(middle)
    between = voltage + m["voltage_rate_v_s"] * h / 2
    lift = np.dot(c, [1, mean[3], mean[3]**2, mean[3]**3, between, mean[3] * between])
    free = axes[:, 2] * lift - [0, 0, m["gravity_m_s2"]]
    early = v + free * h / 2
    k = np.linalg.norm(np.array(m["drag_1_m"]) * (axes.T @ early))
    k -= h * k * k
    new = v + (free - k * early) * h
    return p + (v + new) * h / 2, new, q / np.linalg.norm(q), u, between + m["voltage_rate_v_s"] * h / 2


def lap(flying, tensors, seconds=20):
    """Time from the first crossing of the first gate to its next, s."""
    pilot, start, model = Pilot(flying, tensors), flying["start"], flying["model"]
    p, v, q = np.array(start["position_m"]), np.zeros(3), turn([0, 0, start["heading_rad"]])
    u, voltage, passes = np.array(start["command"], float), start["voltage_v"], []
    h = model["parameters"]["dt_s"]
    for step in range(int(seconds / h)):
        rates = u[:3] * model["parameters"]["max_rate_rad_s"]
        _, action, _ = pilot.step(p, v, q, rates, voltage)
        if pilot.passed is not None:
            passes.append((step - 1 + pilot.passed) * h)
        if len(passes) > len(pilot.gates):
            return passes[-1] - passes[0]
        p, v, q, u, voltage = simulate(model, p, v, q, u, voltage, action)
    return None


def nominal_lap(flying, tensors):
    """The lap and no reason, or no lap and why."""
    if not flying["model"]["complete"]:
        return None, f"training had effects beyond the equations of the file: {', '.join(flying['model']['effects'])}"
    try:
        return lap(flying, tensors), None
    except SystemExit as missed:
        return None, str(missed)


def self_test(flying, tensors, change=None):
    """Largest deviations of observation, action and setpoint, in shares of what is allowed; `change` is a mistake."""
    pilot, states = Pilot(flying, tensors), tensors["self_test.state"].astype(float)
    first = tensors["self_test.observation"][0].astype(float)
    at = {o["name"]: o["first"] for o in flying["observation"]}
    pilot.u = first[at["command"]:][:4]
    pilot.actions = [first[at[f"action_{k}"]:][:4] for k in (1, 2, 3)]
    pilot.target = int(tensors["self_test.target"][0])
    tolerance, worst = flying["self_test"]["tolerance"], np.zeros(4)
    for i, row in enumerate(states):
        state = [row[:3], row[3:6], row[6:10], row[10:13], row[13]]
        if change:
            state = change(pilot, state)
        found = pilot.step(*state)
        for k, name in enumerate(["observation", "action", "setpoint"]):
            off = np.abs(found[k] - tensors[f"self_test.{name}"][i]) / np.array(tolerance[name])
            worst[k] = max(worst[k], off.max())
        worst[3] = max(worst[3], abs(pilot.target - int(tensors["self_test.target"][i])))
    return worst


def noticed(flying, tensors):
    """For each mistake of those who connect a vehicle: whether the self-test fails."""
    def last_w(_, s): s[2] = np.roll(s[2], -1); return s
    def inverse(_, s): s[2] = s[2] * [1, -1, -1, -1]; return s
    def down(_, s): s[0], s[1] = s[0] * [1, -1, -1], s[1] * [1, -1, -1]; return s
    def degrees(_, s): s[3] = np.degrees(s[3]); return s
    def pitch(_, s): s[3] = s[3] * [1, -1, 1]; return s
    def body_velocity(_, s): s[1] = rotation(s[2]).T @ s[1]; return s
    def rates_of_the_world(_, s): s[3] = rotation(s[2]) @ s[3]; return s
    def no_filter(pilot, s): pilot.u = pilot.actions[0]; return s
    def old_history(pilot, s): pilot.actions = [pilot.actions[1], pilot.actions[1], pilot.actions[2]]; return s
    def measured_command(pilot, s): pilot.u[:3] = s[3] / [a["at_one"] for a in flying["action"][:3]] * 0.9; return s
    def no_switch(pilot, s): pilot.last = None; return s
    def late(pilot, s):
        s, pilot.before = getattr(pilot, "before", s), s
        return s
    mistakes = [last_w, inverse, down, degrees, pitch, body_velocity, rates_of_the_world, no_filter, old_history,
                measured_command, no_switch, late]
    out = {}
    for mistake in mistakes:
        try:
            out[mistake.__name__] = bool(self_test(flying, tensors, mistake).max() > 1)
        except SystemExit:
            out[mistake.__name__] = True
    return out


def main():
    metadata, tensors = read(sys.argv[1])
    flying = metadata["flying"]
    seconds, why = nominal_lap(flying, tensors)
    report = {"self_test": self_test(flying, tensors).tolist(), "lap_s": seconds, "no_lap": why,
              "noticed": noticed(flying, tensors), "invalid": []}
    if len(sys.argv) > 2:
        from jsonschema import Draft202012Validator
        schema = json.loads(pathlib.Path(sys.argv[2]).read_text())
        Draft202012Validator.check_schema(schema)
        report["invalid"] = [f"{e.json_path}: {e.message}" for e in Draft202012Validator(schema).iter_errors(metadata)]
    print(json.dumps(report))


if __name__ == "__main__":
    main()
