#!/usr/bin/env python3
"""Draws the figures of RESULTS.md that no command of the program draws, from the CSV files beside this script.

    python3 results/figures.py        needs matplotlib; writes soak.svg, confusion-other-truth.svg and learning.svg
"""

import collections
import statistics

import matplotlib
import tables

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.hashsalt": "racer", "svg.fonttype": "none"})
from matplotlib import pyplot  # noqa: E402

# What every vehicle of the third truth has; neither right nor wrong.
OWN = {"rate_delay", "yaw_delay", "rate_second_order", "yaw_second_order", "rate_slew_limit", "yaw_slew_limit",
       "mixer_thrust_loss", "mixer_room", "response_voltage"}


def save(figure, name):
    figure.savefig(tables.HERE / name, bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def soak():
    """Resident memory of an hour's training."""
    rows = tables.rows("soak")
    figure, axes = pyplot.subplots(figsize=(7, 2.6))
    axes.plot([int(r["seconds"]) / 60 for r in rows], [float(r["rss_mib"]) for r in rows])
    axes.set(xlabel="minutes of training", ylabel="resident memory, MiB", ylim=(0, None))
    axes.grid(alpha=0.3)
    save(figure, "soak.svg")


def learning():
    """Laps from the pad and lap time of the snapshots of trainings of half a minute, one and five, a line a seed."""
    rows = tables.rows("learning")
    figure, axes = pyplot.subplots(2, 3, figsize=(9, 4.2), sharey="row", sharex="col", layout="constrained")
    for column, (minutes, name) in enumerate([("0.5", "half a minute"), ("1", "one minute"), ("5", "five minutes")]):
        seeds = sorted({r["seed"] for r in rows if r["minutes"] == minutes})
        for row, key in enumerate(["fixed_percent", "lap_s"]):
            by_steps = collections.defaultdict(list)
            for seed in seeds:
                of = [r for r in rows if (r["minutes"], r["seed"]) == (minutes, seed) and r[key]]
                million, value = ([float(r[k]) for r in of] for k in ("steps_million", key))
                axes[row, column].plot(million, value, color="tab:blue", alpha=0.35, linewidth=1)
                for at, v in zip(million, value):
                    by_steps[at].append(v)
            middle = {at: statistics.median(of) for at, of in by_steps.items() if 2 * len(of) > len(seeds)}
            axes[row, column].plot(middle.keys(), middle.values(), color="black", linewidth=1.6)
            axes[row, column].grid(alpha=0.3)
        axes[0, column].set(title=f"{name}, {len(seeds)} seeds", ylim=(0, 102))
        axes[1, column].set(xlabel="million steps", ylim=(7, 10))
    axes[0, 0].set_ylabel("laps from the pad, %")
    axes[1, 0].set_ylabel("lap time, s")
    save(figure, "learning.svg")


def first_named(row):
    """The first confident name that is no part of every vehicle, or what was said in its place."""
    for said in row["said"].replace(" (set)", "").split():
        if not said.endswith("?") and said not in OWN and not said.endswith("(drift)"):
            return said
    return "(nothing)"


def confusion():
    """Of logs with one cause or none of the third truth: what is hidden, against what is named first."""
    counts = collections.Counter()
    for row in tables.other_latest("300"):
        if row["group"] in ("none", "one", "outside", "small"):
            hidden = row["hidden"].split("=")[0] or "nothing"
            hidden = f"{hidden} (small)" if row["group"] == "small" else hidden
            hidden = f"{hidden} (outside)" if row["group"] == "outside" else hidden
            counts[hidden, first_named(row)] += 1
    hidden, named = (sorted({pair[k] for pair in counts}) for k in range(2))
    figure, axes = pyplot.subplots(figsize=(0.32 * len(named) + 2.5, 0.2 * len(hidden) + 1.5))
    axes.imshow([[counts[h, n] for n in named] for h in hidden], cmap="Blues", aspect="auto", vmax=5)
    for (h, n), count in counts.items():
        dark = "white" if count > 3 else "black"
        axes.text(named.index(n), hidden.index(h), count, ha="center", va="center", fontsize=7, color=dark)
    axes.set_xticks(range(len(named)), named, rotation=90, fontsize=7)
    axes.set_yticks(range(len(hidden)), hidden, fontsize=7)
    axes.set(xlabel="named first", ylabel="hidden")
    save(figure, "confusion-other-truth.svg")


if __name__ == "__main__":
    soak()
    confusion()
    learning()
