#!/usr/bin/env python3
"""Makes the tables of RESULTS.md from the CSV files beside this script.

    python3 results/tables.py            is every table what its CSV says? exit code 1 and the differences if not
    python3 results/tables.py --write    puts them right

A table stands between `<!-- table: NAME -->` and `<!-- end -->`, NAME being a function of this file.
`results/measure.py` makes the CSV files again.
"""

import csv
import difflib
import math
import pathlib
import re
import statistics
import sys

from measure import PAIRS

HERE = pathlib.Path(__file__).parent
RESULTS = HERE.parent / "RESULTS.md"
BLOCK = re.compile(r"(<!-- table: (\w+)(?: ([\w.-]+))? -->\n)(.*?)(<!-- end -->)", re.S)


def rows(name, **having):
    """The rows of a CSV in which each column `having` names has the text that it gives."""
    with open(HERE / f"{name}.csv", newline="") as file:
        return [row for row in csv.DictReader(file) if all(row[k] == v for k, v in having.items())]


def latest(name):
    """The rows of the build that a CSV ends with."""
    all_rows = rows(name)
    return [row for row in all_rows if row["build"] == all_rows[-1]["build"]]


def table(head, body):
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in [head, *body]).replace(
        "\n", f"\n|{'---|' * len(head)}\n", 1
    )


def wilson(hits, of):
    """`hits of of` with the 95 % interval of the share, in percent."""
    z = 1.96
    share = hits / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    return f"{hits} of {of} ({100 * max(middle - half, 0):.0f} to {100 * min(middle + half, 1):.0f} %)"


def training(minutes):
    """Trainings of so many minutes, seed by seed."""
    head = ["seed", "fixed start", "lap time, s: median (5 to 95 %, best)", "random start", "saturated"]
    return table(
        [*head, "mean abs(da)^2", "steps"],
        [
            (
                r["seed"],
                f"{r['fixed_percent']} %",
                f"{r['lap_s']} ({r['lap_p05_s']} to {r['lap_p95_s']}, best {r['best_s']})",
                f"{r['random_percent']} %",
                f"{r['saturated_percent']} %",
                r["change_sq"],
                f"{r['steps_million']} M",
            )
            for r in rows("training", minutes=minutes)
        ],
    )


def budgets():
    """Trainings of each length: medians over the seeds, and the worst."""
    body = []
    for minutes in ["0.5", "1", "5", "15"]:
        seeds = rows("training", minutes=minutes)
        if not seeds:
            continue
        of = lambda column: [float(r[column]) for r in seeds]
        laps, times, full, change = map(of, ["fixed_percent", "lap_s", "saturated_percent", "change_sq"])
        body.append(
            (
                minutes,
                f"{float(seeds[0]['steps_million']):.0f} M",
                len(seeds),
                f"{statistics.median(laps):.1f} % ({min(laps):.1f})",
                f"{statistics.median(times):.2f} ({min(times):.2f} to {max(times):.2f})",
                f"{statistics.median(full):.1f} % ({max(full):.1f})",
                f"{statistics.median(change):.3f}",
                f"{statistics.median(of('random_percent')):.1f} %",
            )
        )
    head = ["minutes", "steps", "seeds", "pad (worst)", "lap, s (of seeds)", "saturated (worst)"]
    return table([*head, "mean abs(da)^2", "random start"], body)


def refinement():
    """What the end of a training was like, by setting."""
    settings = {}
    for r in rows("refinement"):
        settings.setdefault((r["setting"], r["budget_million"]), {})[r["seed"]] = r
    of = lambda seeds, column: ", ".join(r[column] for r in seeds.values())
    return table(
        ["setting", "million steps", "fixed start, %", "median lap, s", "saturated, %"],
        [
            (setting, steps, of(seeds, "fixed_percent"), of(seeds, "lap_s"), of(seeds, "saturated_percent"))
            for (setting, steps), seeds in settings.items()
        ],
    )


def tried():
    """What other settings of short budgets bring."""
    settings = {}
    for r in rows("tried"):
        settings.setdefault((r["track"], r["setting"], r["steps_million"]), []).append(r)
    body = []
    for (track, setting, steps), seeds in settings.items():
        of = lambda column: [float(r[column]) for r in seeds if r[column]]
        laps = of("fixed_percent")
        enough = f"{sum(x >= 95 for x in laps)} of {len(laps)}"
        lap, full = (f"{statistics.median(of(column)):.{digits}f}" for column, digits in
                     [("lap_s", 2), ("saturated_percent", 1)])
        body.append((track, setting, steps, f"{statistics.mean(laps):.1f} ({min(laps):.1f})", enough, lap, full))
    head = ["track", "setting", "million steps", "laps, %, mean (worst)", "seeds with 95 %", "median lap, s", "saturated, %"]
    return table(head, body)


def loop(name):
    """The loop through a flight controller: trained in, flown."""
    words = {
        "default": "the vehicle as its file says",
        "identified": "**the vehicle as identified**",
        "extended": "as extended",
    }
    return table(
        ["trained in", "seed", "forecast, s", "flown, s", "laps", "ended"],
        [
            (
                words[r["vehicle"]],
                r["seed"],
                f"{float(r['forecast_s']):.2f}",
                f"{float(r['flown_s']):.2f} ({100 * float(r['share']) - 100:+.1f} %)" if r["flown_s"] else "-",
                f"{r['laps']} of 10",
                r["ended"],
            )
            for r in rows(name)
        ],
    )


def rotorpy():
    """Policies in rotorpy, by what they were trained in."""
    flown = lambda r: f"{float(r['flown_s']):.2f} ({100 * float(r['share']) - 100:+.1f} %)" if r["share"] else (
        f"{float(r['flown_s']):.2f}" if r["flown_s"] else "-")
    return table(
        ["trained in the vehicle", "gamma", "seed", "forecast, s", "flown, s", "laps", "ended"],
        [
            (r["trained_in"], r["gamma"], r["seed"], f"{float(r['forecast_s']):.2f}" if r["forecast_s"] else "-",
             flown(r), r["laps"], r["ended"])
            for r in rows("rotorpy")
        ],
    )


def rotorpy_diagnosis():
    """The latest build's flights in rotorpy, by what is hidden."""
    return groups(latest("rotorpy-diagnosis"))


def other_builds(seconds="100"):
    """The third truth's logs of so many seconds by seed and build, of those that flew at least 40, as they were flown."""
    builds = {}
    for r in rows("other-truth", flight_s=seconds):
        builds.setdefault((r["seed"], r["build"]), []).append(r)
    return {key: of for key, of in builds.items() if len(of) >= 40}


def other_latest(seconds="100"):
    """Those of the latest seed."""
    return list(other_builds(seconds).values())[-1]


def other_truth(seconds="100"):
    """The third truth's logs of so many seconds, by seed and build."""
    share = lambda of, said: wilson(sum(map(said, of)), len(of)).replace(" %)", ")").replace(" of ", "/") if of else "-"
    right = lambda r: r["first_right"] == "1"
    body = []
    for (seed, build), of in other_builds(seconds).items():
        hidden = [r for r in of if r["group"] in ("one", "two")]
        clean = [r for r in of if r["group"] == "none"]
        told = [r for r in hidden if r["nameable"] == "1"]
        spurious = lambda r: r["spurious"] != ""
        body.append((f"{seed}, {build}", share(of, spurious), share(clean, spurious), share(hidden, right), share(told, right),
                     share(of, lambda r: r["unexplained"] == "1")))
    head = ["seed, build", "nothing behind a name", "clean: false", "one or two: first"]
    return table([*head, "those that could show", "unexplained (95 %)"], body)


def own_truth():
    """Logs of our own truth, with effects in the catalogue's forms, by what is hidden."""
    of = latest("own-truth")
    is_in = lambda *groups: [r for r in of if r["group"] in groups]
    hidden, outside, clean = is_in("one", "two"), is_in("outside"), is_in("none", "drift")
    written = [r for r in of if r["extended"] == "1"]
    spurious = lambda r: r["spurious"] != ""
    count = lambda which, said: wilson(sum(map(said, which)), len(which)) if which else "-"
    body = [
        ("clean, or the base drifted: a false name", count(clean, spurious), "1 % at most"),
        ("any log: a name with nothing behind it", count(of, spurious), "1 % at most"),
        ("one or two causes: a right one first", count(hidden, lambda r: r["first_right"] == "1"), "95 %"),
        ("two causes: both named or in a set", count(is_in("two"), lambda r: r["found"] == r["of"]), ""),
        ("outside the catalogue: told to be unexplained", count(outside, lambda r: r["unexplained"] == "1"), "90 %"),
        ("outside the catalogue: a confident name", count(outside, spurious), ""),
        ("an extended vehicle is written", count(of, lambda r: r["extended"] == "1"), ""),
        ("of these: train", count(written, lambda r: r["trains"] == "1"), "all"),
        ("more than 2 % worse than the base in a signal of another flight",
         count(written, lambda r: float(r["worst_ratio"]) > 1.02), "none"),
    ]
    return table(["", "found", "goal"], body)


def retraining():
    """Policies in the third truth, trained in the base vehicle and in the extended one: laps of each seed."""
    cases = {}
    for r in rows("retraining-by-motor"):
        cases.setdefault((r["effect"], r["size"], r["trained"]), []).append(r)
    body = []
    for (effect, size, trained), seeds in cases.items():
        times = [float(r["lap_s"]) for r in seeds if r["lap_s"]]
        lap = f"{statistics.median(times):.2f}" if times else "-"
        flown = wilson(sum(int(r["laps"]) for r in seeds), sum(int(r["flown"]) for r in seeds))
        name = effect if effect == "none" else f"{effect} {size}"
        body.append((name, trained, ", ".join(r["laps"] for r in seeds), flown, lap))
    return table(["hidden", "trained in", "laps of 64, by seed", "of all", "lap, s, median of seeds"], body)


def soak():
    """Memory of an hour's training."""
    of = [(int(r["seconds"]), float(r["rss_mib"])) for r in rows("soak")]
    third = lambda a, b: [mib for t, mib in of if a * of[-1][0] / 3 <= t <= b * of[-1][0] / 3]
    spans = [("first", third(0, 1)), ("second", third(1, 2)), ("last", third(2, 3))]
    body = [(f"{name} 20 min", f"{statistics.median(mib):.1f}", f"{max(mib):.1f}") for name, mib in spans]
    return table(["", "resident memory, MiB, median", "most"], body)


def other_groups(seconds="100"):
    """The latest logs of the third truth of so many seconds, by what is hidden."""
    return groups(other_latest(seconds))


def groups(of):
    """Logs by what is hidden in them, and what was said of it."""
    is_in = lambda group: [r for r in of if r["group"] == group]
    right = lambda r: r["first_right"] == "1"
    spurious = lambda r: r["spurious"] != ""
    unexplained = lambda r: r["unexplained"] == "1"
    all_found = lambda r: r["found"] == r["of"]
    asked = {
        "none": ("clean", {"a false name": spurious}),
        "one": ("one", {"right first": right, "a wrong name": spurious}),
        "two": ("two", {"one of them first": right, "both named or in a set": all_found, "a wrong name": spurious}),
        "small": ("small", {"a wrong name": spurious}),
        "outside": ("outside the catalogue", {"told to be unexplained": unexplained, "a confident name": spurious}),
    }
    body = []
    for group, (name, questions) in asked.items():
        which = is_in(group)
        for i, (question, said) in enumerate(questions.items() if which else []):
            share = wilson(sum(map(said, which)), len(which))
            body.append((name if i == 0 else "", len(which) if i == 0 else "", question, share))
    return table(["hidden", "logs", "", "of them"], body)


# Why a log has no line on its vehicle: the program answered, or refused the log.
NOT_ASKED = ["nothing is named", "the log was refused"]


def other_extended(seconds="100"):
    """Their extended vehicles: trained for a moment, and held against another flight."""
    return extended(other_latest(seconds))


def other_unfinished():
    """The third truth's logs of a seed that is not flown whole yet, of all its builds, by what is hidden."""
    return groups(rows("other-truth-seed40"))


def other_unfinished_extended():
    """The extended vehicles of the last build of these."""
    return extended(latest("other-truth-seed40"))


def extended(of):
    """Extended vehicles: written, trained, and worse than the base."""
    written = [r for r in of if r["extended"] == "1"]
    why = {}
    for r in of:
        if r["extended"] != "1":
            why.setdefault(re.sub(r" \d+ %", " some", r["extended"]) or NOT_ASKED[r["verdict"].startswith("FAILED")], []).append(r)
    worse = lambda by: sum(float(r["worst_ratio"]) > 1 + by for r in written)
    # Rows of builds that did not tell it are empty.
    told = [float(r["surely_ratio"]) for r in written if r["surely_ratio"]]
    surely = sum(ratio > 1.02 for ratio in told)
    body = [
        ("written", wilson(len(written), len(of))),
        ("of these: train", wilson(sum(r["trains"] == "1" for r in written), len(written))),
        ("a signal is predicted more than 2 % worse than by the base", wilson(worse(0.02), len(written))),
        ("more than 10 % worse", wilson(worse(0.10), len(written))),
        *([("more than 2 % worse, and that beyond chance", wilson(surely, len(written)))] if told else []),
        ("error of the signal that gains most, over the base's: median",
         f"{statistics.median(float(r['best_ratio']) for r in written):.2f}"),
        *((f"not written: {reason}", len(logs)) for reason, logs in sorted(why.items(), key=lambda x: -len(x[1]))),
    ]
    return table(["extended vehicles", "logs"], body)


def measured_names():
    """What is named in measured flights, a line for each number; sets without a name are left out."""
    of = lambda r: (r["set"], r["what"].replace("_", " "), f"{r['value']} {r['unit']} ({r['low']} to {r['high']})")
    return table(["set", "named", "size (95 %)"], map(of, rows("measured-flights", kind="named")))


def measured_errors(kind, before):
    """Errors on a flight that was not used, of a model without what was named and of the extended vehicle."""
    of = lambda r: (r["set"], r["what"], r["value"], r["low"], r["unit"])
    return table(["set", "signal", before, "extended", ""], map(of, rows("measured-flights", kind=kind)))


def measured_unseen():
    """Those on the flight that nothing has seen."""
    return measured_errors("base and extended", "base")


def measured_all():
    """Those where the diagnosis of all flights leaves the last one out by itself."""
    return measured_errors("held out of all", "compact fit")


def judgement(pair):
    """What became of a pair: as it was written down, or by the columns of the benchmark."""
    if "judgement" in pair:
        return pair["judgement"]
    named = ":named" in pair["said"]
    if not pair["changed"]:
        return "WRONG" if named else "right"
    if named:
        in_set = "in the set" if pair["first_or_set"] == "1" else "WRONG FIRST"
        return "right" if pair["first_right"] == "1" else in_set
    return "could not show" if pair["could_not_show"] == "1" else "MISSED"


def counted(pairs):
    """Pairs of flights without a change and with one, and how many of some have such a judgement."""
    without = [r for r in pairs if r["changed"].startswith("unchanged") or not r["changed"]]
    changed = [r for r in pairs if r not in without]
    return without, changed, lambda of, said: sum(judgement(r) == said for r in of)


def against(file):
    """Pairs of flights, by what is said of them."""
    without, changed, count = counted(latest(file))
    shown = len(changed) - count(changed, "could not show")
    right = count(changed, "right")
    body = [
        ("without: a change is named", wilson(len(without) - count(without, "right"), len(without))),
        ("with: a right name first", wilson(right, len(changed))),
        ("the same, of what the flights could show", wilson(right, shown)),
        ("with: told that these flights could not show it", wilson(len(changed) - shown, len(changed))),
        ("with: only suspected, or not noticed", wilson(count(changed, "MISSED"), len(changed))),
        ("with: a right name in the first set, not first", wilson(count(changed, "in the set"), len(changed))),
        ("with: a wrong name first", wilson(count(changed, "WRONG FIRST"), len(changed))),
    ]
    return table([f"{len(without)} without a change, {len(changed)} with one", "pairs"], body)


def against_runs():
    """All runs of pairs, a row each; the first was written down by hand."""
    body = []
    for seed, *_ in PAIRS:
        file = f"against-seed{seed}"
        run = rows(file)
        first, builds = run[0], ", ".join(dict.fromkeys(r["build"] for r in run if "build" in r))
        without, changed, count = counted(run)
        said = [count(changed, said) for said in ("right", "in the set", "WRONG FIRST", "MISSED", "could not show")]
        named = wilson(len(without) - count(without, "right"), len(without))
        right = wilson(said[0], len(changed))
        body.append((f"[{seed}](results/{file}.csv)", f"{first.get('flight_s', 60)} s", builds or "3b0f02e",
                     named, right, *said[1:]))
    return table(["seed", "flights", "build", "unchanged: a name", "changed: right first", "in a set", "wrong first",
                  "missed", "told not to show"], body)


def by_motors():
    """What motor outputs alone name, by what changed."""
    pairs = rows("against-by-motors")
    told = {"gains": "gains of the rate loop", "low_authority": "turning authority, all axes",
            "weak_yaw": "turning authority, yaw alone", "slow_motors": "slower motors",
            "motor_braking": "motors that brake late", "gyro_filter": "a gyro's filter, 2 to 5 ms",
            "imu_late": "a late IMU"}
    groups = [("nothing", ""), *((name, cause) for cause, name in told.items())]
    body = []
    for name, cause in groups:
        counts = []
        for seeds in (["37"], ["30", "31", "32", "33"]):
            of = [r for r in pairs if r["seed"] in seeds and r["changed"] == cause]
            named = sum(r["first_or_set"] == "1" if cause else bool(r["said"]) for r in of)
            counts.append(wilson(named, len(of)))
        body.append((name, *counts))
    others = [r for r in pairs if r["changed"] and r["changed"] not in told]
    wrong = lambda seeds: [bool(r["said"]) for r in others if r["seed"] in seeds]
    body.append(("another cause", *(wilson(sum(w), len(w)) for w in (wrong(["37"]), wrong(["30", "31", "32", "33"])))))
    return table(["what changed", "given a name, `--seed 37`", "seeds 30 to 33"], body)


def plan():
    """What planned flights tell apart."""
    tied = [r for r in latest("plan") if r["apart"] and r["tied"] == "1"]
    lengths = [float(r["plan_s"]) for r in tied]
    apart = sum(r["apart"] == "1" for r in tied)
    return table(
        ["tied flights of one effect", ""],
        [
            ("told apart: the right cause named, and nothing else", wilson(apart, len(tied))),
            ("planned flight, median and longest", f"{statistics.median(lengths):.0f} s, {max(lengths):.0f} s"),
        ],
    )


def blackbox():
    """Blackbox logs against blackbox_decode."""
    flights = rows("blackbox-decode")
    total = lambda column: sum(int(r[column]) for r in flights)
    spaced = lambda n: f"{n:,}".replace(",", " ")
    differ = total("differing_cells") + total("rows_missing") + total("gps_differing_cells")
    return table(
        ["flights", "rows", "cells compared", "differing or missing", "rows only racer reads"],
        [(len(flights), spaced(total("rows")), spaced(total("cells")), differ, total("rows_more"))],
    )


def precision():
    """Samples to 95 % of laps, by the factors' precision and the size of the minibatches."""
    settings = {}
    for r in rows("precision-and-minibatch"):
        settings.setdefault(r["setting"], {}).setdefault(r["seed"], []).append(r)
    body = []
    for setting, seeds in settings.items():
        first = [next((int(r["steps"]) for r in s if float(r["laps_percent"]) >= 95), None) for s in seeds.values()]
        last = [s[-1] for s in seeds.values()]
        million = " ".join("-" if steps is None else f"{steps / 1e6:.0f}" for steps in first)
        median = statistics.median([math.inf if steps is None else steps / 1e6 for steps in first])
        laps = statistics.mean(float(r["laps_percent"]) for r in last)
        lap = statistics.median(float(r["lap_s"]) for r in last)
        body.append((f"`{setting}`, {len(seeds)} seeds", million, f"{median:.0f}", f"{laps:.1f} %", f"{lap:.2f}"))
    head = ["", "first snapshot with 95 % laps, M steps", "median", "laps at the end, mean", "lap, s, median"]
    return table(head, body)


TABLES = [training, budgets, refinement, tried, loop, rotorpy, rotorpy_diagnosis, other_truth, other_groups, own_truth,
          retraining, soak, other_extended, other_unfinished,
          other_unfinished_extended, against, against_runs, by_motors, plan, blackbox, precision,
          measured_names, measured_unseen, measured_all]
MADE = {f.__name__: f for f in TABLES}


def made(match):
    begin, name, argument, _, end = match.groups()
    if name not in MADE:
        sys.exit(f"RESULTS.md: no table `{name}`; there are {', '.join(sorted(MADE))}")
    return begin + MADE[name](*filter(None, [argument])) + end


def main():
    text = RESULTS.read_text()
    again, count = BLOCK.subn(made, text)
    if sys.argv[1:] == ["--write"]:
        RESULTS.write_text(again)
    elif sys.argv[1:]:
        sys.exit(__doc__)
    elif again != text:
        sys.stdout.writelines(difflib.unified_diff(text.splitlines(True), again.splitlines(True), "RESULTS.md", "CSV"))
        sys.exit("tables of RESULTS.md differ from their CSV: results/tables.py --write puts them right")
    print(f"{count} tables of RESULTS.md are what their CSV files say")


if __name__ == "__main__":
    main()
