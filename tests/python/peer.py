"""A simulated vehicle for `racer pilot`: flown over UDP, in real time, from a policy file alone.

    racer pilot RUN --in udp:9101 --out udp:127.0.0.1:9102 --laps 3 --log flight.mcap &
    python3 tests/python/peer.py RUN/policy.safetensors 9101 9102 [SECONDS]

Sends states (packets in docs/flying.md) and flies the setpoints that come back, until the pilot says that it has ended.
The switch is held from the moment that the pilot is ready. With SECONDS the vehicle flies that long and its pack never
empties; without, ten minutes at most.
"""

import json
import socket
import struct
import sys
import time

import numpy as np
from fly import read, simulate, turn

PHASES = ["waiting", "ready", "flying", "ended"]


def main():
    path, to, port = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    seconds = float(sys.argv[4]) if len(sys.argv) > 4 else None
    flying = read(path)[0]["flying"]
    start, model = flying["start"], flying["model"]
    full = np.array([a["at_one"] for a in flying["action"][:3]])
    p, v, q = np.array(start["position_m"]), np.zeros(3), turn([0, 0, start["heading_rad"]])
    u, voltage = np.array(start["command"], float), start["voltage_v"]
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.bind(("127.0.0.1", port))
    link.setblocking(False)
    period, phases, phase, number, answered = model["parameters"]["dt_s"], [], 0, 0, 0
    begun, most = time.monotonic(), (seconds or 600) / period
    while phase != 3 and number < most:
        rates = u[:3] * model["parameters"]["max_rate_rad_s"]
        state = struct.pack("<4sIQ14fI", b"RST1", number, int(number * period * 1e6), *p, *v, *q, *rates, voltage,
                            phase in (1, 2))
        link.sendto(state, ("127.0.0.1", to))
        number += 1
        time.sleep(max(0.0, begun + number * period - time.monotonic()))
        newest = None
        while True:
            try:
                newest = link.recv(64)
            except BlockingIOError:
                break
        if newest is None:
            continue
        mark, phase, _, _, valid, *setpoint = struct.unpack("<4sIQII6f", newest)
        assert mark == b"RSP1"
        if not phases or phases[-1] != PHASES[phase]:
            phases.append(PHASES[phase])
        if valid:
            action = np.array([*(setpoint[:3] / full), 2 * setpoint[3] - 1])
            p, v, q, u, left = simulate(model, p, v, q, u, voltage, action)
            voltage = left if seconds is None else voltage
            answered += 1
    print(json.dumps({"phases": phases, "states": number, "flown": answered}))


if __name__ == "__main__":
    main()
