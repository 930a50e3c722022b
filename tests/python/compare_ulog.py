"""Compares racer's ULog reader with pyulog, every number of every column of every topic.

    pip install pyulog
    cargo build --release --example ulog_columns
    python3 tests/python/compare_ulog.py --out results/ulog-pyulog.csv LOG.ulg...

Exits with 1 where a number differs, or a column is missing.
"""

import argparse
import csv
import hashlib
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from pyulog import ULog

COLUMNS = ["log", "sha256", "topics", "columns", "rows", "numbers", "differing", "columns_missing", "columns_more"]


def ours(log, program, folder):
    printed = subprocess.run([program, str(log), folder], check=True, capture_output=True, text=True).stdout
    lines = (line.split("\t") for line in printed.splitlines())
    return {(topic, column): np.fromfile(pathlib.Path(folder) / name, "<f8") for topic, column, _, name in lines
            if column != "@log_time" and "_padding" not in column}


def theirs(log):
    columns = {}
    for topic in ULog(str(log)).data_list:
        name = topic.name if topic.multi_id == 0 else f"{topic.name}#{topic.multi_id}"
        for column, values in topic.data.items():
            # Bytes that only fill up a record.
            if "_padding" not in column:
                columns[name, column] = values.astype(float)
    return columns


def compare(log, program):
    with tempfile.TemporaryDirectory() as folder:
        mine, other = ours(log, program, folder), theirs(log)
    shared = [key for key in other if key in mine]
    differing = 0
    for key in shared:
        if len(mine[key]) != len(other[key]):
            differing += max(len(mine[key]), len(other[key]))
        else:
            differing += int(np.sum(~((mine[key] == other[key]) | (np.isnan(mine[key]) & np.isnan(other[key])))))
    # A topic that was declared and never logged has no columns for pyulog.
    logged = {topic for topic, _ in other}
    more = [key for key in mine if key not in other and key[0] in logged]
    rows = {topic: len(values) for (topic, _), values in other.items()}
    return [pathlib.Path(log).name, hashlib.sha256(pathlib.Path(log).read_bytes()).hexdigest()[:16], len(logged),
            len(shared), sum(rows.values()), sum(len(other[key]) for key in shared), differing,
            len(other) - len(shared), len(more)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+")
    parser.add_argument("--racer", default="target/release/examples/ulog_columns", help="the example, built")
    parser.add_argument("--out", help="table to write, as CSV")
    options = parser.parse_args()
    rows = [dict(zip(COLUMNS, compare(log, options.racer))) for log in options.logs]
    with open(options.out, "w", newline="", encoding="utf-8") if options.out else sys.stdout as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    wrong = sum(row["differing"] + row["columns_missing"] for row in rows)
    print(f"{len(rows)} logs, {sum(row['numbers'] for row in rows)} numbers compared, {wrong} differ or are missing",
          file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
