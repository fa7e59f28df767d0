#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures how seconds and bytes of learning grow with interactions, bits and classes.

    tools/bench/curves.py build/release/tools/run_gridworld/run_gridworld [CURVE...] [--most N]

Curves, each with the other two held: `interactions` (1e3 to 1e7 in Sutton's maze, 18 bits, 46 cells),
`bits` (18 to 512, 5,000 interactions in Sutton's maze) and `classes` (46 to about 4,000 cells, drawn as
`rooms` of mazes.py, 18 bits and more, 40 interactions a cell). Ten learning steps each, seed 1. Seconds
are of processor time of the whole run, playing and compaction included. The exponent is the slope of a
line through the logarithms of the last three points: before them, what every run costs counts. --most
leaves out points above so many interactions, bits or classes. Needs numpy.
"""

import argparse
import json
import math
import random
import resource
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from mazes import rooms, text_of

STEPS = 10
INTERACTIONS = (10**3, 10**4, 10**5, 10**6, 10**7)
BITS = (18, 32, 64, 128, 256, 512)
SIDES = (None, 10, 20, 40, 72)


def learn(program, folder, *options):
    """The report of a run, and its processor time."""
    report = Path(folder) / "report.json"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "binary", "--steps", STEPS, "--json", report, *options]
    subprocess.run([*map(str, command)], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return json.loads(report.read_bytes()), seconds


def points_of(curve, program, folder, most):
    """(size, report, seconds) of each point."""
    if curve == "interactions":
        for count in INTERACTIONS:
            if count <= most:
                yield count, *learn(program, folder, "--interactions", count)
    elif curve == "bits":
        for bits in BITS:
            if bits <= most:
                yield bits, *learn(program, folder, "--distractors", bits - 7)
    else:
        for side in SIDES:
            options, cells = [], 46
            if side:
                maze = Path(folder) / "maze.txt"
                free, exit_cell = rooms(side, random.Random(1))
                maze.write_text(text_of(side, free, exit_cell), encoding="ascii")
                options, cells = ["--maze", maze], len(free) - 1
            if cells <= most:
                options += ["--interactions", 40 * cells // STEPS * STEPS]
                report, seconds = learn(program, folder, *options)
                yield report["classes"], report, seconds


def slope(sizes, values):
    return np.polyfit(np.log(sizes), np.log(values), 1)[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("curves", nargs="*", default=["interactions", "bits", "classes"])
    parser.add_argument("--most", type=float, default=math.inf)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for curve in arguments.curves:
            print(curve)
            points = []
            for size, report, seconds in points_of(curve, arguments.program, folder, arguments.most):
                points.append((size, seconds, report["memory_bytes"]))
                print(f"  {size:>10,}  {seconds:9.2f} s  {points[-1][2]:>13,} bytes", flush=True)
            sizes, seconds, memory = zip(*points[-3:], strict=True)
            if len(points) > 1:
                print(f"  exponent    {slope(sizes, seconds):9.2f}    {slope(sizes, memory):13.2f}")


if __name__ == "__main__":
    main()
