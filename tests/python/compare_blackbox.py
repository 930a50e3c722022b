"""Compares racer's blackbox reader with blackbox_decode, every field of every row, as recorded.

    cargo build --release --example blackbox_csv
    python3 tests/python/compare_blackbox.py --decoder blackbox_decode --out results/blackbox-decode.csv LOG...

`blackbox_decode` is built from github.com/betaflight/blackbox-tools, tag v0.4.3. (Later sources no longer
look at what follows a frame: on damaged logs they give rows of damage, and end at the first byte 0xff.) It
does not read the events that a flight mode changed or why the vehicle was disarmed, takes them for damage,
and leaves out the rows up to the next whole frame; racer reads these rows: `rows_more`. Exits with 1 where
a cell differs, or racer lacks a row.
"""

import argparse
import collections
import csv
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile

RAW = ["amperage", "vbat", "flags", "height", "rotation", "acceleration", "gps-speed"]
COLUMNS = ["firmware", "sha256", "flight", "rows", "fields", "cells", "differing_cells", "rows_missing",
           "rows_more", "events_unread_by_blackbox_decode", "gps_rows", "gps_differing_cells"]


def table(path):
    """Names, and rows by time, iteration and how often these were there before."""
    if not path.is_file():
        return [], {}
    with open(path, newline="", encoding="latin-1") as file:
        lines = csv.reader(file, skipinitialspace=True)
        names = [name.split(" (")[0].strip() for name in next(lines, [])]
        place = [names.index(name) for name in ("time", "loopIteration") if name in names]
        seen, rows = collections.Counter(), {}
        for cells in lines:
            key = tuple(int(cells[i]) for i in place)
            seen[key] += 1
            rows[key + (seen[key],)] = cells
    return names, rows


def number(cell):
    """Whole numbers of 32 bits; coordinates and courses are written with a point that was not recorded."""
    return int(cell.replace(".", "").strip()) % 2**32


def compare(ours, theirs, skip=()):
    names, rows = ours
    other_names, other_rows = theirs
    missing = set(names) - set(other_names)
    if other_names and missing:
        raise SystemExit(f"fields that blackbox_decode does not have: {missing}")
    pairs = [(i, other_names.index(name)) for i, name in enumerate(names) if other_names and name not in skip]
    shared = [key for key in other_rows if key in rows]
    differing = sum(number(rows[key][i]) != number(other_rows[key][j]) for key in shared for i, j in pairs)
    return {"rows": len(rows), "fields": len(names), "cells": len(shared) * len(pairs), "differing": differing,
            "missing": len(other_rows) - len(shared), "more": len(rows) - len(shared)}


def flights(log, options, folder):
    content = pathlib.Path(log).read_bytes()
    starts = [found.start() for found in re.finditer(b"H Product:Blackbox", content)] + [len(content)]
    units = [word for unit in RAW for word in (f"--unit-{unit}", "raw")]
    printed = subprocess.run([options.racer, str(log), str(folder)], check=True, capture_output=True, text=True)
    for line in printed.stdout.splitlines():
        flight, firmware, frames, events = line.split("\t")
        # Each in a file of its own: blackbox_decode finds no more than 31 in one.
        alone = folder / f"{flight}.bfl"
        alone.write_bytes(content[starts[int(flight) - 1]:starts[int(flight)]])
        subprocess.run([options.decoder, *units, str(alone)], check=False, capture_output=True)
        theirs = table(folder / f"{flight}.01.csv")
        if int(frames) == 0 and not theirs[1]:
            continue
        main = compare(table(folder / f"{flight}.main.csv"), theirs)
        gps = compare(table(folder / f"{flight}.gps.csv"), table(folder / f"{flight}.01.gps.csv"))
        digest = hashlib.sha256(content).hexdigest()[:16]
        row = [firmware, digest, flight, main["rows"], main["fields"], main["cells"], main["differing"],
               main["missing"], main["more"], events, gps["rows"],
               gps["differing"] + gps["fields"] * (gps["missing"] + gps["more"])]
        yield dict(zip(COLUMNS, row))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+")
    parser.add_argument("--decoder", default="blackbox_decode", help="the program to compare with")
    parser.add_argument("--racer", default="target/release/examples/blackbox_csv", help="the example, built")
    parser.add_argument("--out", help="table to write, as CSV")
    options = parser.parse_args()
    rows = []
    for log in options.logs:
        with tempfile.TemporaryDirectory() as folder:
            rows += flights(log, options, pathlib.Path(folder))
    rows.sort(key=lambda row: (row["firmware"], row["sha256"], int(row["flight"])))
    with open(options.out, "w", newline="", encoding="utf-8") if options.out else sys.stdout as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    wrong = sum(row["differing_cells"] + row["rows_missing"] + row["gps_differing_cells"] for row in rows)
    cells = sum(row["cells"] for row in rows)
    print(f"{len(rows)} flights, {cells} cells compared, {wrong} differ or are missing", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
