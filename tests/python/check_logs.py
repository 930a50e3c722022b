"""What `racer check` says of flight logs, beside what is true of them.

    pip install pyulog
    cargo build --release
    python3 tests/python/check_logs.py --data FOLDER --out results/check-logs.csv [LOG...]

FOLDER (default: the variable RACER_FLIGHT_DATA) is searched for logs; more may be named. What is true of a PX4 log
is read with pyulog from what the flight controller says of itself (type, and seconds that it is armed and not
landed); of the others it stands in TRUE below, from the descriptions of the data, and is empty where nobody says.
Of a blackbox file the longest flight counts.
"""

import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys

COLUMNS = ["log", "length_s", "type_true", "type_said", "armed", "in_air_true_s", "usable_said_s", "exit_code",
           "problems"]
# Folder or name, type, and whether it is in the air for most of the log.
TRUE = [(r"nanobench/|neurobem/|indiflight/|betaflight/", "multirotor")]
NUMBERS = {1: "fixed_wing", 2: "multirotor", 4: "helicopter", 10: "rover", 13: "multirotor", 14: "multirotor"}


def held(times, values, at):
    """The last value at or before a time, the first before all."""
    best = values[0]
    for time, value in zip(times, values):
        if time > at:
            break
        best = value
    return best


def of_px4(path):
    from pyulog import ULog

    log = ULog(str(path))
    data = {topic.name: topic.data for topic in reversed(log.data_list) if topic.multi_id == 0}
    status = data["vehicle_status"]
    kind = NUMBERS.get(log.initial_parameters.get("MAV_TYPE"), "other")
    kind = "vtol" if "is_vtol" in status and max(status["is_vtol"]) == 1 else kind
    armed = [state == 2 for state in status["arming_state"]]
    landed = data.get("vehicle_land_detected")
    imu = data["sensor_combined"]["timestamp"]
    steps = range(int(imu[0]), int(imu[-1]), 100_000)
    air = None
    if landed is not None:
        air = 0.1 * sum(not held(landed["timestamp"], landed["landed"], t) and held(status["timestamp"], armed, t)
                        for t in steps)
    elif not any(armed):
        air = 0.0
    return kind, "yes" if any(armed) else "never", "" if air is None else f"{air:.1f}"


def row(path, root, racer):
    name = str(path.relative_to(root)) if path.is_relative_to(root) else f"{path.parent.name}/{path.name}"
    ran = subprocess.run([racer, "check", "--json", str(path)], capture_output=True, text=True, check=False)
    if path.suffix == ".ulg":
        kind, armed, air = of_px4(path)
    else:
        kind = next((kind for pattern, kind in TRUE if re.search(pattern, name)), "")
        armed, air = "", ""
    if not ran.stdout.startswith("{"):
        said = ran.stderr.strip().splitlines() or [""]
        return dict(zip(COLUMNS, [name, "", kind, "", armed, air, "", ran.returncode, "not read: " + said[-1]]))
    check = json.loads(ran.stdout)
    imu = next((stream["span_s"] for stream in check["streams"] if stream["stream"] == "imu"), None)
    usable = sum(to - start for start, to in check["usable_s"])
    problems = [finding["kind"] for finding in check["findings"] if finding["severity"] == "problem"]
    length = f"{imu[1] - imu[0]:.1f}" if imu else ""
    return dict(zip(COLUMNS, [name, length, kind, check["vehicle"]["kind"] or "", armed, air, f"{usable:.1f}",
                              ran.returncode, " ".join(problems)]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="*", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("RACER_FLIGHT_DATA"))
    parser.add_argument("--racer", default="target/release/racer")
    parser.add_argument("--out", help="table to write, as CSV")
    options = parser.parse_args()
    root = pathlib.Path(options.data or ".")
    ends = (".csv.gz", ".bbl", ".bfl", ".ulg", ".mcap")
    found = sorted(path for path in root.rglob("*") if str(path).lower().endswith(ends)
                   and "_gps." not in path.name) if options.data else []
    rows = [row(path, root, options.racer) for path in [*found, *options.logs]]
    with open(options.out, "w", newline="", encoding="utf-8") if options.out else sys.stdout as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
