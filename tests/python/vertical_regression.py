#!/usr/bin/env python3
"""What an ordinary regression leaves of NeuroBEM's vertical specific force on a flight that it has not seen.

    python tests/python/vertical_regression.py FLIGHTS

FLIGHTS is the folder of the data set's logs. Three are fitted, 171908seg2 is predicted; m/s2 RMS.
"""

import csv
import gzip
import sys
from pathlib import Path

import numpy as np

FITTED = ["20210218170320seg2", "20210223104803seg2", "20210218172600seg1"]
UNSEEN = "20210218171908seg2"


def load(path):
    with gzip.open(path, "rt") as file:
        rows = csv.reader(file)
        names = next(rows)
        return dict(zip(names, np.array([[float(x) for x in row] for row in rows]).T))


def columns(log, drag, offset):
    v, w, a = ([log[f"{name}_{axis}"] for axis in "xyz"] for name in ("velbody", "angvel", "angacc"))
    across = np.hypot(v[0], v[1])
    along = {"v_z": [v[2]], "v_z |v|": [v[2] * np.hypot(across, v[2])], "v_z and v_z v_h": [v[2], v[2] * across]}
    out = [sum(log[f"mot{i}_radps"] ** 2 for i in range(1, 5)) * 1e-6, v[0] ** 2, v[1] ** 2, *along[drag]]
    if offset:
        out += [w[0] * w[2] - a[1], w[1] * w[2] + a[0], -(w[0] ** 2) - w[1] ** 2]
    return np.column_stack(out)


def main():
    logs = [load(Path(sys.argv[1]) / f"neurobem_{name}.csv.gz") for name in [*FITTED, UNSEEN]]
    for drag, offset in [("v_z", False), ("v_z |v|", False), ("v_z |v|", True), ("v_z and v_z v_h", True)]:
        each = [columns(log, drag, offset) for log in logs]
        force = np.concatenate([log["acc_z"] for log in logs[:-1]])
        sizes = np.linalg.lstsq(np.vstack(each[:-1]), force, rcond=None)[0]
        left = logs[-1]["acc_z"] - each[-1] @ sizes
        print(f"{drag}{', offset' if offset else ''}: {np.sqrt(np.mean(left**2)):.3f}")


if __name__ == "__main__":
    main()
