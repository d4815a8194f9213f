#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Report of the validation: short, its commands list rows, and its table is that of its rows. So is that of the fits.

    validation_report.py ROOT
"""
import collections
import csv
import pathlib
import re
import subprocess
import sys

MOST_BYTES = 25_000
KEY = ("chapter", "section", "case", "quantity", "unit", "source")
# Name, comparisons, outside their bounds, worst share of a bound, worst comparison.
SUMMARY = re.compile(r"^\| \d+ \| .* \| `(\w+)` \| (\d+) \| (\d+) \| (\S+) \| (.*) \|$", re.MULTILINE)
faults = []


def check(condition, fault):
    if not condition:
        faults.append(fault)


def share(row):
    difference, bound = float(row["difference"]), float(row["bound"])
    return difference / bound if difference else 0.0


def check_rows(rows):
    keys = collections.Counter(tuple(row[column] for column in KEY) for row in rows)
    complete = all(None not in row and None not in row.values() for row in rows)
    check(complete, "rows differ in their number of fields")
    for key, count in keys.items():
        check(count == 1, f"{count} rows are called {key}")


def check_summary(text, rows):
    summary = SUMMARY.findall(text)
    names = list(dict.fromkeys(row["chapter"] for row in rows))
    check([name for name, *_ in summary] == names, f"the chapters are not {names}")
    for name, comparisons, outside, worst_share, worst in summary:
        compared = [row for row in rows if row["chapter"] == name and row["bound"]]
        check(int(comparisons) == len(compared), f"{name}: {len(compared)} comparisons")
        failed = sum(row["holds"] != "yes" for row in compared)
        check(int(outside) == failed, f"{name}: {failed} comparisons outside their bounds")
        # Differences have two digits.
        largest = max(map(share, compared))
        check(abs(largest - float(worst_share)) <= 0.06 * largest, f"{name}: worst comparison has {largest}")
        named = [share(row) for row in compared if row["quantity"] == worst.replace("\\|", "|")]
        check(named and max(named) >= 0.94 * largest, f"{name}: worst comparison is not \"{worst}\"")


def check_commands(text, root):
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    commands = [line for block in blocks for line in block.splitlines()]
    check(commands, "no commands")
    for command in commands:
        listed = subprocess.run(command, shell=True, cwd=root, capture_output=True, text=True, check=False)
        check(listed.returncode == 0 and len(listed.stdout.splitlines()) > 5, f"lists no rows: {command}")


def check_fits(folder):
    text = (folder / "FITS.md").read_text(encoding="utf-8")
    kinds = collections.defaultdict(lambda: collections.defaultdict(dict))
    with open(folder / "fits.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            kinds[row["kind"]][row["set"]][row["parameter"]] = row
    check(kinds, "there are no fits")
    for kind, sets in kinds.items():
        def count(holds, sets=sets):
            return sum(holds(one) for one in sets.values())

        def error(row):
            return abs(float(row["value"]) - float(row["truth"]))

        def is_inside(row):
            return float(row["low"].replace("null", "-inf")) <= float(row["truth"]) <= float(row["high"].replace("null", "inf"))

        def has_peak(one):
            row = one["clearance_mm"]
            return abs(float(row["predicted_peak"]) / float(row["measured_peak"]) - 1) <= 0.05

        counts = [len(sets), count(lambda one: error(one["clearance_mm"]) <= 0.02 * float(one["clearance_mm"]["truth"])),
                  count(lambda one: error(one["restitution"]) <= 0.02), count(has_peak),
                  count(lambda one: all(map(is_inside, one.values())))]
        line = f"| {kind} | " + " | ".join(map(str, counts)) + " |"
        check(line in text, f"FITS.md has no line of fits.csv as it is: {line}")


def main():
    root = pathlib.Path(sys.argv[1])
    folder = root / "validation"
    text = (folder / "VALIDATION.md").read_text(encoding="utf-8")
    size = len(text.encode())
    check(size <= MOST_BYTES, f"the report has {size} bytes, more than {MOST_BYTES}")
    with open(folder / "rows.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    check_rows(rows)
    check_summary(text, rows)
    check_commands(text, root)
    check_fits(folder)
    linked = set(re.findall(r"\]\(figures/(\w+\.svg)\)", text))
    drawn = {path.name for path in (folder / "figures").iterdir()}
    check(linked == drawn, f"figures that stand in one of report and folder: {sorted(linked ^ drawn)}")
    for fault in faults:
        print(fault)
    print(f"{len(rows)} rows, {size} bytes of report")
    sys.exit(1 if faults else 0)


main()
