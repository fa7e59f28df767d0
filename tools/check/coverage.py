#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails unless what `llvm-cov export` wrote says that every line, branch and condition of core/src and core/domains
was covered, but for those in UNREACHABLE. tools/coverage runs it. Lines are taken from LCOV, the second file: it
counts a line of an inline function as covered if it was in any of the files that include it.

A condition is covered if two of the tests differ in the decision because of it alone (modified condition/decision
coverage). Decisions of a single condition are the branches."""

import argparse
import json
import pathlib
import sys
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
MEASURES = ("functions", "lines", "branches", "mcdc")
NAMES = {"mcdc": "conditions"}


class Unreachable(NamedTuple):
    file: str
    text: str  # in the file; where it no longer is, the entry is stale
    missed: dict  # how many of a measure
    why: str


LARGE = "a size above SIZE_MAX needs a size_t of 32 bits: the emulated microcontrollers of tests/targets have one"
UNREACHABLE = [
    Unreachable("core/src/agent/agent.c", "if (arena.used > SIZE_MAX) {", {"lines": 3, "branches": 1}, LARGE),
    Unreachable("core/src/counts/learn_counts.c", "if (arena.used > SIZE_MAX)", {"lines": 1, "branches": 1}, LARGE),
    Unreachable("core/src/policy/min_tree.c", "if (arena.used > SIZE_MAX)", {"lines": 1, "branches": 1}, LARGE),
    Unreachable("core/src/policy/policy.c", "if (arena.used > SIZE_MAX)", {"lines": 1, "branches": 1}, LARGE),
]


def missed(file):
    """How many of each measure a file misses, without zeros."""
    counts = {measure: file["summary"][measure]["count"] - file["summary"][measure]["covered"]
              for measure in MEASURES}
    return {measure: count for measure, count in counts.items() if count}


def read_lines(text):
    """Of each file in a report of LCOV: how many lines there are and how many were covered."""
    lines = {}
    for record in text.split("end_of_record\n"):
        name, counts = None, []
        for line in record.splitlines():
            if line.startswith("SF:"):
                name = line[3:]
            elif line.startswith("DA:"):
                counts.append(int(line.split(",")[1]))
        lines[name] = {"count": len(counts), "covered": sum(count > 0 for count in counts)}
    return lines


def places(file):
    """The branches and decisions in which something is missed; in a function that is compiled in several files, also
    those that another one covers."""
    for branch in file["branches"]:
        if (branch[4] == 0) != (branch[5] == 0):
            yield branch[0], branch[1], f"never {'true' if branch[4] == 0 else 'false'}"
    for record in file.get("mcdc_records", []):
        numbers = [str(i + 1) for i, shown in enumerate(record[-1]) if not shown]
        if numbers and len(numbers) < len(record[-1]):
            yield record[0], record[1], f"not shown to decide: condition {', '.join(numbers)} of {len(record[-1])}"


def excused(name, text):
    """What may be missed of a file, and the entries that say so of a line that is no longer there."""
    total, stale = {}, []
    for entry in UNREACHABLE:
        if entry.file == name:
            if entry.text not in text:
                stale.append(entry)
            for measure, count in entry.missed.items():
                total[measure] = total.get(measure, 0) + count
    return total, stale


def faults_of(file, name, text):
    """What is wrong with a file, a line each."""
    may, stale = excused(name, text)
    for entry in stale:
        yield f"tools/check/coverage.py: {name} no longer has: {entry.text}"
    if missed(file) != may:
        yield f"{name}: missed {missed(file)}, to be missed {may}"
        for line, column, what in sorted(set(places(file))):
            yield f"    {name}:{line}:{column}: {what}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("json", type=pathlib.Path)
    parser.add_argument("lcov", type=pathlib.Path)
    arguments = parser.parse_args()
    summaries, faults = {}, []
    lines = read_lines(arguments.lcov.read_text(encoding="utf-8"))
    for file in json.loads(arguments.json.read_text(encoding="utf-8"))["data"][0]["files"]:
        path = pathlib.Path(file["filename"])
        if any((ROOT / folder) in path.parents for folder in ("core/src", "core/domains")):
            name = str(path.relative_to(ROOT))
            file["summary"]["lines"] = lines[file["filename"]]
            summaries[name] = file["summary"]
            faults += faults_of(file, name, path.read_text(encoding="utf-8"))
    faults += [f"tools/check/coverage.py: no such file: {entry.file}"
               for entry in UNREACHABLE if entry.file not in summaries]
    print(*faults, sep="\n", end="\n" if faults else "")
    for measure in MEASURES:
        covered, count = (sum(summary[measure][key] for summary in summaries.values())
                          for key in ("covered", "count"))
        print(f"{NAMES.get(measure, measure):11}{covered:6} of {count}")
    print(f"{len(UNREACHABLE)} places cannot be reached on this machine; {len(faults)} lines of faults")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
